// CmaDistribution: the normal distribution of CMA-ES and its adaptation by a ranked generation
// (N. Hansen, The CMA Evolution Strategy: A Tutorial, arXiv:1604.00772; positive weights, §A).
// Unbounded coordinates; who samples folds them into the box. Fixed size, no heap. RT safe.
#pragma once

#include "platform/base/random.hpp"
#include "src/search/symmetric_eigen.hpp"

namespace gannet::search {

class CmaDistribution {
 public:
  explicit CmaDistribution(int dimension) : n_(static_cast<std::size_t>(dimension)) {}

  // A sphere of radius sigma about mean; lambda samples a generation.
  void start(const SmallVector& mean, double sigma, int lambda);

  // A step y of the distribution N(0, C): the sample is mean + sigma · y.
  SmallVector draw_step(Random& random) const;

  int parents() const { return parents_; }
  // One generation: step(k) is the k-th best sample's step, k < parents().
  template <class Step>
  void adapt(Step&& step) {
    SmallVector mean_step = {};
    SmallMatrix spread = {};
    double weight_sum = 0;
    for (int k = 0; k < parents_; ++k) weight_sum += weight(k);
    for (int k = 0; k < parents_; ++k) add(step(k), weight(k) / weight_sum, mean_step, spread);
    adapt(mean_step, spread);
  }

  const SmallVector& mean() const { return mean_; }
  double sigma() const { return sigma_; }
  const SmallMatrix& covariance() const { return covariance_; }  // of the steps
  double longest_axis() const;                                   // standard deviation
  double shortest_axis() const;                                  // standard deviation

 private:
  double weight(int k) const;  // log(λ/2 + ½) − log(k + 1)
  void add(const SmallVector& step, double weight, SmallVector& mean_step,
           SmallMatrix& spread) const;
  void adapt(const SmallVector& mean_step, const SmallMatrix& spread);
  void adapt_covariance(const SmallVector& mean_step, const SmallMatrix& spread, bool moving);
  void decompose();

  std::size_t n_;
  int parents_ = 1;
  double effective_parents_ = 1;
  double log_half_ = 0;
  double path_rate_sigma_ = 0, damping_ = 1, path_rate_c_ = 0, rank_one_ = 0, rank_mu_ = 0;
  double expected_norm_ = 1;
  double forgotten_ = 1;  // (1 − c_σ)^(2g)
  double sigma_ = 1;
  SmallVector mean_ = {};
  SmallVector path_sigma_ = {};
  SmallVector path_c_ = {};
  SmallMatrix covariance_ = {};
  SmallMatrix axes_ = {};     // columns
  SmallVector lengths_ = {};  // of the axes, standard deviations
};

}  // namespace gannet::search
