// DifferentialEvolution: a population whose members are displaced by differences of other members
// (Storn & Price 1997) and that lives on from frame to frame. When a frame begins, the worst part
// is re-seeded, part of it near the hint (or the last best) and part anywhere, and all members are
// scored again; so acquisition, tracking and re-acquisition are one mechanism.
// Generations are synchronous. Creation start-up only; all else RT safe, one thread.
#pragma once

#include "src/search/generational_optimiser.hpp"
#include "src/search/search_config.hpp"

namespace gannet::search {

class DifferentialEvolution final : public GenerationalOptimiser {
 public:
  // dimension 1 … 8; config as its description allows.
  DifferentialEvolution(int dimension, const DifferentialEvolutionConfig& config,
                        std::uint64_t seed);

  void reset(std::uint64_t seed) override;
  void begin_frame(std::span<const float> hint) override;

 private:
  enum class Strategy { kMix, kRand1, kCurrentToBest };

  void evolve() override;
  void take_scores();
  void reseed(std::span<const float> hint);
  void propose_members();
  void propose_trials();
  void make_trial(int member, std::span<float> trial);
  int other_than(int a, int b, int c);

  const Strategy strategy_;
  const float scale_min_;
  const float scale_span_;
  const float crossover_;
  const int best_count_;
  const int reseed_count_;
  const int reseed_local_count_;
  const float local_radius_;
  bool trials_ = false;  // the candidates are trials, else the members themselves
  Random random_;
  Population members_;
};

}  // namespace gannet::search
