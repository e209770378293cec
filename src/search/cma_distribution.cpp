#include "src/search/cma_distribution.hpp"

#include <algorithm>
#include <cmath>

#include "src/search/exact_math.hpp"

namespace gannet::search {

double CmaDistribution::weight(int k) const { return log_half_ - exact_log(k + 1); }

// Rates are the tutorial's Table 1.
void CmaDistribution::start(const SmallVector& mean, double sigma, int lambda) {
  mean_ = mean;
  sigma_ = sigma;
  parents_ = std::max(lambda / 2, 1);
  log_half_ = exact_log(lambda / 2.0 + 0.5);
  double sum = 0;
  double squares = 0;
  for (int k = 0; k < parents_; ++k) {
    sum += weight(k);
    squares += weight(k) * weight(k);
  }
  const double n = static_cast<double>(n_);
  const double mu = effective_parents_ = sum * sum / squares;
  path_rate_sigma_ = (mu + 2) / (n + mu + 5);
  damping_ = 1 + 2 * std::max(0.0, std::sqrt((mu - 1) / (n + 1)) - 1) + path_rate_sigma_;
  path_rate_c_ = (4 + mu / n) / (n + 4 + 2 * mu / n);
  rank_one_ = 2 / ((n + 1.3) * (n + 1.3) + mu);
  rank_mu_ = std::min(1 - rank_one_, 2 * (mu - 2 + 1 / mu) / ((n + 2) * (n + 2) + mu));
  expected_norm_ = std::sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n));
  forgotten_ = 1;
  path_sigma_ = path_c_ = lengths_ = {};
  covariance_ = axes_ = {};
  for (std::size_t i = 0; i < n_; ++i) covariance_[i][i] = axes_[i][i] = lengths_[i] = 1;
}

SmallVector CmaDistribution::draw_step(Random& random) const {
  SmallVector z = {};
  for (std::size_t i = 0; i < n_; ++i) z[i] = lengths_[i] * static_cast<double>(random.normal_f());
  SmallVector y = {};
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t j = 0; j < n_; ++j) y[i] += axes_[i][j] * z[j];
  }
  return y;
}

void CmaDistribution::add(const SmallVector& step, double weight, SmallVector& mean_step,
                          SmallMatrix& spread) const {
  for (std::size_t i = 0; i < n_; ++i) {
    mean_step[i] += weight * step[i];
    for (std::size_t j = 0; j < n_; ++j) spread[i][j] += weight * step[i] * step[j];
  }
}

void CmaDistribution::adapt(const SmallVector& mean_step, const SmallMatrix& spread) {
  for (std::size_t i = 0; i < n_; ++i) mean_[i] += sigma_ * mean_step[i];
  const double rate = path_rate_sigma_;
  double square = 0;
  // C^(−1/2) · mean_step = axes · lengths^(−1) · axesᵀ · mean_step
  SmallVector along = {};
  for (std::size_t j = 0; j < n_; ++j) {
    for (std::size_t i = 0; i < n_; ++i) along[j] += axes_[i][j] * mean_step[i];
    along[j] /= lengths_[j];
  }
  const double gain = std::sqrt(rate * (2 - rate) * effective_parents_);
  for (std::size_t i = 0; i < n_; ++i) {
    double white = 0;
    for (std::size_t j = 0; j < n_; ++j) white += axes_[i][j] * along[j];
    path_sigma_[i] = (1 - rate) * path_sigma_[i] + gain * white;
    square += path_sigma_[i] * path_sigma_[i];
  }
  forgotten_ *= (1 - rate) * (1 - rate);
  const double norm = std::sqrt(square);
  const double n = static_cast<double>(n_);
  // The path is not unusually long: else the covariance would run away while sigma grows.
  const bool moving = norm / std::sqrt(1 - forgotten_) < (1.4 + 2 / (n + 1)) * expected_norm_;
  adapt_covariance(mean_step, spread, moving);
  sigma_ *= exact_exp(std::min(1.0, rate / damping_ * (norm / expected_norm_ - 1)));
  sigma_ = std::min(sigma_, 1.0);  // the whole box
  decompose();
}

void CmaDistribution::adapt_covariance(const SmallVector& mean_step, const SmallMatrix& spread,
                                       bool moving) {
  const double rate = path_rate_c_;
  const double gain = moving ? std::sqrt(rate * (2 - rate) * effective_parents_) : 0;
  for (std::size_t i = 0; i < n_; ++i) path_c_[i] = (1 - rate) * path_c_[i] + gain * mean_step[i];
  const double kept = 1 - rank_one_ - rank_mu_ + (moving ? 0 : rank_one_ * rate * (2 - rate));
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t j = 0; j < n_; ++j) {
      covariance_[i][j] =
          kept * covariance_[i][j] + rank_one_ * path_c_[i] * path_c_[j] + rank_mu_ * spread[i][j];
    }
  }
}

void CmaDistribution::decompose() {
  symmetric_eigen(covariance_, static_cast<int>(n_), axes_, lengths_);
  for (std::size_t i = 0; i < n_; ++i) lengths_[i] = std::sqrt(std::max(lengths_[i], 1e-20));
}

double CmaDistribution::longest_axis() const {
  return sigma_ * *std::max_element(lengths_.begin(), lengths_.begin() + static_cast<long>(n_));
}

double CmaDistribution::shortest_axis() const {
  return sigma_ * *std::min_element(lengths_.begin(), lengths_.begin() + static_cast<long>(n_));
}

}  // namespace gannet::search
