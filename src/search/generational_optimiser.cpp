#include "src/search/generational_optimiser.hpp"

#include <algorithm>
#include <cassert>

namespace gannet::search {

GenerationalOptimiser::GenerationalOptimiser(int capacity, int dimension)
    : candidates_(capacity, dimension) {
  assert(dimension >= 1 && dimension <= kMaxDimension);
  best_genes_.fill(0.5f);
}

void GenerationalOptimiser::forget_best() {
  forget_best_score();
  has_last_best_ = false;
  best_genes_.fill(0.5f);
}

void GenerationalOptimiser::clear_candidates() {
  count_ = 0;
  scored_ = 0;
  proposed_ = 0;
}

std::span<float> GenerationalOptimiser::add_candidate() {
  assert(count_ < candidates_.capacity());
  candidates_.set_score(count_, kNoScore);
  return candidates_.genes(count_++);
}

int GenerationalOptimiser::propose(std::span<float> genes) {
  const int room = static_cast<int>(genes.size()) / dimension();
  assert(room >= 1 && count_ > scored_);
  proposed_ = std::min(room, count_ - scored_);
  for (int i = 0; i < proposed_; ++i) {
    copy(candidates_.genes(scored_ + i), genes.subspan(static_cast<std::size_t>(i * dimension())));
  }
  return proposed_;
}

void GenerationalOptimiser::learn(std::span<const float> scores) {
  const int n = std::min(proposed_, static_cast<int>(scores.size()));
  proposed_ = 0;
  for (int i = 0; i < n; ++i) {
    const float given = scores[static_cast<std::size_t>(i)];
    const float score = given == given ? given : kNoScore;
    candidates_.set_score(scored_, score);
    if (score > best_score_) {
      best_score_ = score;
      has_last_best_ = true;
      copy(candidates_.genes(scored_), best_genes_);
    }
    ++scored_;
  }
  if (scored_ == count_) evolve();
}

float GenerationalOptimiser::best(std::span<float> genes) const {
  assert(static_cast<int>(genes.size()) >= dimension());
  std::copy_n(best_genes_.begin(), dimension(), genes.begin());
  return best_score_;
}

}  // namespace gannet::search
