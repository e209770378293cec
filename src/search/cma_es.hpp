// CmaEs: evolution strategy that learns its covariance (Hansen, arXiv:1604.00772), restarted
// within a frame whenever it has converged or stands still. A frame starts near the hint (or the
// last best) with a small step; restarts start anywhere, with a growing population (Auger &
// Hansen, CEC 2005). Samples beyond the box are mirrored back into it, so the distribution itself
// knows no border. Creation start-up only; all else RT safe, one thread.
#pragma once

#include <vector>

#include "src/search/cma_distribution.hpp"
#include "src/search/generational_optimiser.hpp"
#include "src/search/search_config.hpp"

namespace gannet::search {

class CmaEs final : public GenerationalOptimiser {
 public:
  // dimension 1 … 8; config as its description allows.
  CmaEs(int dimension, const CmaEsConfig& config, std::uint64_t seed);

  void reset(std::uint64_t seed) override;
  void begin_frame(std::span<const float> hint) override;
  int restarts() const { return restarts_; }  // within this frame

 private:
  void evolve() override;
  void start_near(std::span<const float> centre);
  void start_anywhere();
  void start(const SmallVector& mean, double sigma);
  bool run_is_over() const;
  void propose_samples(bool with_mean);

  const CmaEsConfig config_;
  const int first_lambda_;
  int lambda_;
  int restarts_ = 0;
  int generations_without_better_ = 0;
  float best_of_run_ = kNoScore;
  bool flat_ = false;
  Random random_;
  CmaDistribution distribution_;
  std::vector<SmallVector> steps_;  // of the candidates
};

}  // namespace gannet::search
