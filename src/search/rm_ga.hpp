// RmGa: the papers' real-time multi-step genetic algorithm (P001 §2.6, P002 §II-D, P004 §3.3):
// binary chromosomes; evaluation → sorting → removal of the weak → crossover → mutation, as often
// as a frame's time allows; the population goes on to the next frame. Rules that the papers leave
// open are choices in RmGaConfig. Creation start-up only; all else RT safe, one thread.
#pragma once

#include <vector>

#include "src/search/chromosome.hpp"
#include "src/search/generational_optimiser.hpp"
#include "src/search/search_config.hpp"

namespace gannet::search {

class RmGa final : public GenerationalOptimiser {
 public:
  // dimension 1 … 8; config as its description allows. Three genes are coded as P004's.
  RmGa(int dimension, const RmGaConfig& config, std::uint64_t seed);

  void reset(std::uint64_t seed) override;
  void begin_frame(std::span<const float> hint) override;

 private:
  enum class Parents { kAnySurvivor, kRanked, kBestWithSurvivor };
  enum class Crossover { kOnePoint, kTwoPoint, kUniform, kGene };
  enum class Mutation { kOneBit, kEachBit, kOneGene };
  struct Individual {
    Chromosome chromosome;
    float score = kNoScore;
    bool scored = false;
  };

  void evolve() override;
  void take_scores();
  void sort();
  void replace_the_weak();
  int parent(bool first);
  void cross(Chromosome& a, Chromosome& b);
  void mutate(Chromosome& c);
  Chromosome draw();
  void write_candidates();

  const Coding coding_;
  const int survivors_;
  const int elite_;
  const double mutation_rate_;
  const bool mutate_survivors_;
  const bool score_survivors_again_;
  const bool use_hint_;
  const Parents parents_;
  const Crossover crossover_;
  const Mutation mutation_;
  Random random_;
  std::vector<Individual> individuals_;
  std::vector<int> asked_;  // the individual behind each candidate; room for all
};

}  // namespace gannet::search
