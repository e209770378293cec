// RivalWatch: the global search that goes on while a target is locked, a little in every frame. It
// keeps the best places elsewhere from frame to frame, as gene vectors: in each frame they are
// scored again, some candidates try to climb from them and others come from anywhere. So what would
// be a better answer is found within some frames, and how far the locked pose stands out stays
// known (docs/design/search.md). Scores are of the coarsest level. Fixed size, RT safe, one thread.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "platform/base/random.hpp"

namespace gannet::track {

class RivalWatch {
 public:
  static constexpr int kGenes = 6;

  // Forgets all places.
  void reset(std::uint64_t seed);
  // A place that another search came across.
  void offer(std::span<const float> genes, float score);

  // Writes `count` candidates (at least kPlaces), kGenes each.
  void propose(std::span<float> genes, int count);
  // Their scores, in order; is_own(i): candidate i is a view of the locked pose, no rival.
  template <class IsOwn>
  void learn(std::span<const float> genes, std::span<const float> scores, IsOwn&& is_own) {
    for (std::size_t i = 0; i < scores.size(); ++i) {
      learn_one(i, genes.subspan(i * kGenes, kGenes), is_own(i) ? kNone : scores[i]);
    }
  }

  // The best place and its score; below −1 when there is none.
  std::span<const float> best() const { return places_[best_at()].genes; }
  float best_score() const { return places_[best_at()].score; }

  static constexpr int kPlaces = 12;

 private:
  static constexpr float kNone = -2;
  struct Place {
    std::array<float, kGenes> genes = {};
    float score = kNone;
    float reach = 0;  // standard deviation of the next candidates about it
  };
  std::size_t best_at() const;
  void learn_one(std::size_t i, std::span<const float> genes, float score);

  std::array<Place, kPlaces> places_ = {};
  Random random_;
};

}  // namespace gannet::track
