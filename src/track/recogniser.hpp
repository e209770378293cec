// Recogniser: fitness + optimiser + refinement: finds one target in one prepared pair, from nothing
// or from a hint. Holds either a photo-model (six degrees of freedom) or a rectangle of the left
// image (Pb3DP). create() is start-up only; all else RT safe, one thread (work may be spread by the
// Parallel that it is given; the answer does not depend on it).
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "platform/base/parallel.hpp"
#include "platform/base/result.hpp"
#include "src/search/optimiser.hpp"
#include "src/track/recognition.hpp"
#include "src/track/relief.hpp"
#include "src/track/rival_watch.hpp"
#include "src/track/search_space.hpp"
#include "src/track/track_config.hpp"
#include "src/vision/fitness.hpp"
#include "src/vision/refine.hpp"

namespace gannet::track {

enum class TargetKind { kModel, kRectangle };

class Recogniser {
 public:
  // kernels: "auto" or a name of kernel_choice.hpp. max_workers: of the Parallel that will be used.
  static Result<std::unique_ptr<Recogniser>> create(const TrackConfig& config, const StereoRig& rig,
                                                    TargetKind kind, int max_workers = 1,
                                                    std::string_view kernels = "auto");

  vision::PlaneNeeds needs() const;

  // Both forget what was sought before and restart the search from the configured seed.
  // False: too many points for what was reserved.
  bool set_model(const vision::PatchModel& model);
  // The rectangle's pixels are taken from this frame's left image. False: outside the image or
  // smaller than 8 × 8 pixels; nothing changes then.
  bool set_rectangle(const vision::Rectangle& rectangle, const vision::PreparedFrame& frame);
  // New pixels for the same rectangle, the search goes on.
  bool refresh_rectangle(const vision::Rectangle& rectangle, const vision::PreparedFrame& frame);

  // hint: the predicted pose, or null. budget.evaluations 0: the configured number.
  Recognition recognise(const vision::PreparedFrame& frame,
                        const Transform<LeftCamera, Target>* hint, const Budget& budget,
                        Parallel& parallel);

  // The quick way, for a target that is locked and whose pose is nearly known: place() on the
  // coarse levels, follow() at full detail. can_follow(): with this config and target.
  // coarse_level(): the finest level that place() looks at. region(): where follow() will look, in
  // each eye.
  bool can_follow() const;
  int coarse_level() const { return std::min(2, target_.levels - 1); }
  Transform<LeftCamera, Target> place(const vision::PreparedFrame& frame,
                                      const Transform<LeftCamera, Target>& hint,
                                      Parallel& parallel);
  struct Regions {
    vision::Region left, right;
    bool ok = false;  // all of the target is before both cameras
  };
  Regions region(const Transform<LeftCamera, Target>& placed, int margin_px) const;
  // with_watch: the global check goes on, too (watch_candidates of the config).
  Recognition follow(const vision::PreparedFrame& frame,
                     const Transform<LeftCamera, Target>& placed, bool with_watch,
                     Parallel& parallel);

  // The score of one pose of a model, and the same for many: the fitness distribution of P001 §2.5.
  void score(const vision::PreparedFrame& frame, std::span<const vision::Hypothesis> hypotheses,
             std::span<float> scores, Parallel& parallel);

  // The rectangle at its pose as a metric photo-model: points and colours (method §2).
  // out.points must have room for max_points() where no heap is allowed.
  bool to_model(const Transform<LeftCamera, Target>& pose, vision::PatchModel& out) const;

  const vision::TargetPoints& target() const { return target_; }
  static constexpr int max_points() { return 4096; }

 private:
  Recogniser(const TrackConfig& config, const StereoRig& rig, TargetKind kind, int max_workers);

  bool assign_levels(double projected_size_px, double spacing_px);
  void score_batch(const vision::PreparedFrame& frame, int level, int n, Parallel& parallel);
  void note_rivals(int n);
  bool elsewhere(const std::array<double, 3>& place, const vision::Hypothesis& answer) const;
  float best_rival(const vision::Hypothesis& answer) const;
  void challenge(const vision::PreparedFrame& frame, Recognition& own);
  int mirror(const Transform<LeftCamera, Target>& pose,
             std::array<vision::Hypothesis, 3>& out) const;
  double tilts_cost(int tilts, int answers) const;
  void try_tilts(const vision::PreparedFrame& frame, bool all, Recognition& best);
  void watch(const vision::PreparedFrame& frame, const vision::Hypothesis& own, Parallel& parallel);
  float score_one(const vision::PreparedFrame& frame, int level, const vision::Hypothesis& q);
  Recognition finish(const vision::PreparedFrame& frame, const vision::Hypothesis& best,
                     float best_score, double evaluations, bool locked = false);
  double found_threshold() const;
  bool is_target(const vision::PreparedFrame& frame, const vision::Hypothesis& answer, bool locked,
                 Recognition& out);
  Eigen::Vector3d ray_of(const Eigen::Vector2d& pixel, const Eigen::Vector3d& plane) const;
  Eigen::Vector3d aimed(const Eigen::Vector3d& ray, const Eigen::Vector3d& from,
                        const Eigen::Vector3d& to) const;
  vision::Refinement refine_plane(const vision::PreparedFrame& frame,
                                  const Transform<LeftCamera, Target>& start);

  const TrackConfig config_;
  // Rectangles through a port: rays come from its pupil, and the left frame is there inside.
  const Eigen::Vector3d eye_;
  const vision::RigOptics optics_;
  const StereoRig& rig_;
  const TargetKind kind_;
  SearchSpace space_;
  std::unique_ptr<vision::Fitness> fitness_;
  std::unique_ptr<search::Optimiser> optimiser_;
  vision::TargetPoints target_;
  bool has_target_ = false;
  // The source of target_'s levels.
  std::vector<vision::ModelPoint> points_;
  std::vector<vision::ModelPoint> coarse_;
  vision::Yuv background_;
  double spacing_ = 0;
  Eigen::Vector2d size_m_ = Eigen::Vector2d::Zero();
  vision::Rectangle rectangle_;
  Eigen::Vector3d centre_ray_ = Eigen::Vector3d::UnitZ();
  // The planes (n/d) that the rays of points_ and of target_'s finest level are aimed at.
  Eigen::Vector3d aim_ = Eigen::Vector3d::UnitZ(), level_aim_ = Eigen::Vector3d::UnitZ();
  // The best score in each cell of the searched x–y (or z) range at the coarsest level, and its
  // place: what the best wrong answer would score.
  struct Rival {
    float score;
    std::array<double, 3> translation;
    std::array<float, 8> genes;
  };
  static constexpr int kRivalCells = 16;
  std::vector<Rival> rivals_;
  Relief relief_;
  RivalWatch watch_;
  bool watch_is_seeded_ = false;
  Random random_;                   // of place()
  Eigen::Vector2d low_m_, high_m_;  // the bounding box of the points
  // Batches.
  std::vector<float> genes_;
  std::vector<vision::Hypothesis> hypotheses_;
  std::vector<float> scores_;
  std::vector<vision::Scratch> scratch_;
};

}  // namespace gannet::track
