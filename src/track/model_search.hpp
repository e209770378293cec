// ModelSearch: which of many models is in view (P001 §2.2: the database is searched). Each frame
// tries some of them from nothing with a part of the frame's budget; when all have been tried, the
// best few get full searches in the frames after, and the best of these is the answer if it is
// found and clearly ahead of every other model. create() is start-up only; all else RT safe, one
// thread.
#pragma once

#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "src/track/recogniser.hpp"

namespace gannet::track {

class ModelSearch {
 public:
  static constexpr int kMostModels = 64;
  static constexpr int kAFrame = 3;      // models tried in a frame
  static constexpr int kFinals = 3;      // models searched in full, one a frame
  static constexpr double kAhead = 0.1;  // in fitness, of the best other model

  // Error: no model, too many, one with too many points, or what Recogniser::create says.
  static Result<std::unique_ptr<ModelSearch>> create(const TrackConfig& config,
                                                     const StereoRig& rig,
                                                     std::vector<vision::PatchModel> models,
                                                     int max_workers = 1,
                                                     std::string_view kernels = "auto");

  vision::PlaneNeeds needs() const { return recogniser_->needs(); }
  int models() const { return static_cast<int>(models_.size()); }
  // Frames until the first answer.
  int frames() const { return (models() + kAFrame - 1) / kAFrame + finals(); }

  // Forgets what was seen.
  void restart();

  struct Answer {
    bool done = false;   // a round is over; the next frame begins another
    int model = -1;      // in view; −1: none for sure
    double fitness = 0;  // of the best model, whether sure or not
    int best = -1;       // that model
    double ahead = 0;    // of every other one
    Recognition seen;    // of `model`
  };
  // One frame. evaluations 0: the configured number, for all that is tried in it.
  Answer look(const vision::PreparedFrame& frame, double evaluations, Parallel& parallel);

 private:
  ModelSearch(const TrackConfig& config, std::vector<vision::PatchModel> models,
              std::unique_ptr<Recogniser> recogniser)
      : config_(config), models_(std::move(models)), recogniser_(std::move(recogniser)) {
    restart();
  }
  int finals() const { return std::min(kFinals, models()); }
  Recognition search(int model, const vision::PreparedFrame& frame, double evaluations,
                     Parallel& parallel);
  void choose_finalists();
  Answer judge() const;

  const TrackConfig config_;
  const std::vector<vision::PatchModel> models_;
  std::unique_ptr<Recogniser> recogniser_;
  int tried_ = 0;     // models of this round
  int searched_ = 0;  // finalists of this round
  std::array<double, kMostModels> fitness_ = {};
  std::array<int, kFinals> finalists_ = {};
  std::array<Recognition, kFinals> seen_;
};

}  // namespace gannet::track
