#include "src/search/differential_evolution.hpp"

#include <algorithm>

namespace gannet::search {
namespace {

// Four different members are needed for a trial.
int at_least_six(int population) { return std::max(population, 6); }

int share_of(double share, int n) { return std::clamp(static_cast<int>(share * n + 0.5), 0, n); }

}  // namespace

DifferentialEvolution::DifferentialEvolution(int dimension,
                                             const DifferentialEvolutionConfig& config,
                                             std::uint64_t seed)
    : GenerationalOptimiser(at_least_six(config.population), dimension),
      strategy_(config.strategy == "rand_1"            ? Strategy::kRand1
                : config.strategy == "current_to_best" ? Strategy::kCurrentToBest
                                                       : Strategy::kMix),
      scale_min_(static_cast<float>(config.scale_min)),
      scale_span_(static_cast<float>(std::max(config.scale_max - config.scale_min, 0.0))),
      crossover_(static_cast<float>(config.crossover)),
      best_count_(std::max(share_of(config.best_share, at_least_six(config.population)), 1)),
      // The best always stays.
      reseed_count_(std::min(share_of(config.reseed_share, at_least_six(config.population)),
                             at_least_six(config.population) - 1)),
      reseed_local_count_(share_of(config.reseed_local, reseed_count_)),
      local_radius_(static_cast<float>(config.local_radius)),
      random_(seed),
      members_(at_least_six(config.population), dimension) {
  reset(seed);
}

void DifferentialEvolution::reset(std::uint64_t seed) {
  random_.seed(seed);
  for (int i = 0; i < members_.capacity(); ++i) {
    draw_anywhere(random_, members_.genes(i));
    members_.set_score(i, kNoScore);
  }
  forget_best();
  propose_members();
}

void DifferentialEvolution::begin_frame(std::span<const float> hint) {
  take_scores();  // of the generation that the last frame's end cut off
  members_.rank();
  if (has_last_best() || !hint.empty()) reseed(hint);
  if (!hint.empty()) {
    // The hint is a member itself, in the place of the very worst.
    std::span<float> worst = members_.genes(members_.ranked(members_.capacity() - 1));
    for (std::size_t i = 0; i < worst.size(); ++i) worst[i] = fold(hint[i]);
  }
  forget_best_score();
  propose_members();
}

void DifferentialEvolution::reseed(std::span<const float> hint) {
  const std::span<const float> centre = hint.empty() ? last_best() : hint;
  for (int k = 0; k < reseed_count_; ++k) {
    const int i = members_.ranked(members_.capacity() - 1 - k);
    if (k < reseed_local_count_) {
      draw_near(random_, centre, local_radius_, members_.genes(i));
    } else {
      draw_anywhere(random_, members_.genes(i));
    }
  }
}

void DifferentialEvolution::evolve() {
  take_scores();
  members_.rank();
  propose_trials();
}

// A trial that is at least as good takes its member's place; equal ones too, so that a plateau of
// votes is walked across.
void DifferentialEvolution::take_scores() {
  for (int i = 0; i < scored_count(); ++i) {
    const float score = candidate_score(i);
    if (trials_) {
      if (score < members_.score(i)) continue;
      copy(candidate(i), members_.genes(i));
    }
    members_.set_score(i, score);
  }
}

void DifferentialEvolution::propose_members() {
  trials_ = false;
  clear_candidates();
  for (int i = 0; i < members_.capacity(); ++i) copy(members_.genes(i), add_candidate());
}

void DifferentialEvolution::propose_trials() {
  trials_ = true;
  clear_candidates();
  for (int i = 0; i < members_.capacity(); ++i) make_trial(i, add_candidate());
}

int DifferentialEvolution::other_than(int a, int b, int c) {
  for (;;) {
    const int i = random_.below(members_.capacity());
    if (i != a && i != b && i != c) return i;
  }
}

void DifferentialEvolution::make_trial(int member, std::span<float> trial) {
  const bool to_best = strategy_ == Strategy::kCurrentToBest ||
                       (strategy_ == Strategy::kMix && random_.below(2) == 1);
  const float scale = scale_min_ + scale_span_ * random_.uniform_f();
  const int best = members_.ranked(random_.below(best_count_));
  const int r1 = other_than(member, member, member);
  const int r2 = other_than(member, r1, r1);
  const int r3 = other_than(member, r1, r2);
  const std::span<const float> own = members_.genes(member);
  const std::span<const float> base = to_best ? own : members_.genes(r3);
  const std::span<const float> target = members_.genes(best);
  const std::span<const float> plus = members_.genes(r1);
  const std::span<const float> minus = members_.genes(r2);
  const int always = random_.below(dimension());  // at least one gene is the mutant's
  for (std::size_t i = 0; i < trial.size(); ++i) {
    const bool mutant = random_.uniform_f() < crossover_ || static_cast<int>(i) == always;
    const float pull = to_best ? scale * (target[i] - own[i]) : 0.0f;
    trial[i] = mutant ? fold(base[i] + pull + scale * (plus[i] - minus[i])) : own[i];
  }
}

}  // namespace gannet::search
