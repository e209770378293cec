// GenerationalOptimiser: the ask–tell half of every optimiser that thinks in generations. It hands
// a generation out in portions of whatever size the caller has room for, gathers the scores, and
// calls evolve() when all are in. So the search is the same for every portion size, and a learn()
// with fewer scores than candidates (a deadline came between) loses nothing: the rest is proposed
// again. A score that is not a number counts as the worst.
// The constructor is start-up only; all else RT safe, one thread. Owned by its maker.
#pragma once

#include <array>

#include "src/search/optimiser.hpp"
#include "src/search/population.hpp"

namespace gannet::search {

class GenerationalOptimiser : public Optimiser {
 public:
  int dimension() const final { return candidates_.dimension(); }
  int propose(std::span<float> genes) final;
  void learn(std::span<const float> scores) final;
  float best(std::span<float> genes) const final;

 protected:
  GenerationalOptimiser(int capacity, int dimension);

  // All candidates are scored: take their scores and write the next generation.
  virtual void evolve() = 0;

  // Starts a new generation; add_candidate() then gives the genes of one more to fill in.
  void clear_candidates();
  std::span<float> add_candidate();
  std::span<const float> candidate(int i) const { return candidates_.genes(i); }
  float candidate_score(int i) const { return candidates_.score(i); }
  int candidate_count() const { return count_; }
  // Best first; ranked_candidate(k) as of the last rank_candidates().
  void rank_candidates() { candidates_.rank(count_); }
  int ranked_candidate(int k) const { return candidates_.ranked(k); }
  // The first so many candidates have scores; fewer than all only when a frame ended between.
  int scored_count() const { return scored_; }

  // A new frame: the best's place is still the best guess (last_best), its score is void.
  void forget_best_score() { best_score_ = kNoScore; }
  void forget_best();
  bool has_last_best() const { return has_last_best_; }
  std::span<const float> last_best() const {
    return {best_genes_.data(), static_cast<std::size_t>(dimension())};
  }

 private:
  Population candidates_;
  int count_ = 0;
  int scored_ = 0;
  int proposed_ = 0;  // of them, by the last propose()
  bool has_last_best_ = false;
  float best_score_ = kNoScore;
  std::array<float, kMaxDimension> best_genes_;
};

}  // namespace gannet::search
