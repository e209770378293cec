#include "src/search/cma_es.hpp"

#include <algorithm>

#include "src/search/exact_math.hpp"

namespace gannet::search {
namespace {

int lambda_of(const CmaEsConfig& config, int dimension) {
  if (config.population > 0) return std::max(config.population, 4);
  return 4 + static_cast<int>(3 * exact_log(dimension));
}

}  // namespace

CmaEs::CmaEs(int dimension, const CmaEsConfig& config, std::uint64_t seed)
    : GenerationalOptimiser(std::max(lambda_of(config, dimension), config.population_max),
                            dimension),
      config_(config),
      first_lambda_(lambda_of(config, dimension)),
      lambda_(first_lambda_),
      random_(seed),
      distribution_(dimension),
      steps_(static_cast<std::size_t>(std::max(first_lambda_, config.population_max))) {
  reset(seed);
}

void CmaEs::reset(std::uint64_t seed) {
  random_.seed(seed);
  forget_best();
  begin_frame({});
}

void CmaEs::begin_frame(std::span<const float> hint) {
  lambda_ = first_lambda_;
  restarts_ = 0;
  forget_best_score();
  if (!hint.empty()) {
    start_near(hint);
  } else if (has_last_best()) {
    start_near(last_best());
  } else {
    start_anywhere();
  }
}

void CmaEs::start_near(std::span<const float> centre) {
  SmallVector mean = {};
  for (std::size_t i = 0; i < centre.size(); ++i) mean[i] = static_cast<double>(fold(centre[i]));
  start(mean, config_.sigma_hint);
  propose_samples(true);
}

void CmaEs::start_anywhere() {
  SmallVector mean = {};
  for (int i = 0; i < dimension(); ++i) mean[static_cast<std::size_t>(i)] = random_.uniform();
  start(mean, config_.sigma);
  propose_samples(false);
}

void CmaEs::start(const SmallVector& mean, double sigma) {
  distribution_.start(mean, sigma, lambda_);
  best_of_run_ = kNoScore;
  generations_without_better_ = 0;
}

// with_mean: the first sample is the mean itself, since it is somebody's good guess.
void CmaEs::propose_samples(bool with_mean) {
  clear_candidates();
  for (int k = 0; k < lambda_; ++k) {
    SmallVector& step = steps_[static_cast<std::size_t>(k)];
    step = with_mean && k == 0 ? SmallVector{} : distribution_.draw_step(random_);
    const std::span<float> genes = add_candidate();
    for (std::size_t i = 0; i < genes.size(); ++i) {
      genes[i] =
          fold(static_cast<float>(distribution_.mean()[i] + distribution_.sigma() * step[i]));
    }
  }
}

void CmaEs::evolve() {
  rank_candidates();
  const float best = candidate_score(ranked_candidate(0));
  flat_ = best == candidate_score(ranked_candidate(lambda_ - 1));
  generations_without_better_ = best > best_of_run_ ? 0 : generations_without_better_ + 1;
  best_of_run_ = std::max(best_of_run_, best);
  distribution_.adapt([this](int k) -> const SmallVector& {
    return steps_[static_cast<std::size_t>(ranked_candidate(k))];
  });
  if (!run_is_over()) {
    propose_samples(false);
    return;
  }
  ++restarts_;
  lambda_ = std::clamp(static_cast<int>(lambda_ * config_.restart_growth + 0.5), first_lambda_,
                       std::max(first_lambda_, config_.population_max));
  start_anywhere();
}

bool CmaEs::run_is_over() const {
  constexpr double kThinnest = 1e-7;  // of the longest axis: floats resolve no thinner one
  return flat_ || distribution_.longest_axis() < config_.tolerance ||
         distribution_.shortest_axis() < kThinnest * distribution_.longest_axis() ||
         generations_without_better_ > config_.patience * dimension();
}

}  // namespace gannet::search
