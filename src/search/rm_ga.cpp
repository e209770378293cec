#include "src/search/rm_ga.hpp"

#include <algorithm>
#include <cassert>

namespace gannet::search {
namespace {

Coding make_coding(int dimension, const RmGaConfig& config) {
  const bool gray = config.coding == "gray";
  if (dimension == 3 && config.bits_of_three_genes.size() == 3) {
    return Coding(config.bits_of_three_genes, gray);
  }
  return Coding(std::vector<int>(static_cast<std::size_t>(dimension), config.bits_per_gene), gray);
}

}  // namespace

RmGa::RmGa(int dimension, const RmGaConfig& config, std::uint64_t seed)
    : GenerationalOptimiser(std::max(config.population, 4), dimension),
      coding_(make_coding(dimension, config)),
      survivors_(std::clamp(static_cast<int>(config.survival * std::max(config.population, 4)), 2,
                            std::max(config.population, 4) - 1)),
      elite_(std::clamp(config.elite, 1, survivors_)),
      mutation_rate_(config.mutation_rate),
      mutate_survivors_(config.mutate_survivors),
      score_survivors_again_(config.score_survivors_again),
      use_hint_(config.use_hint),
      parents_(config.parents == "ranked"               ? Parents::kRanked
               : config.parents == "best_with_survivor" ? Parents::kBestWithSurvivor
                                                        : Parents::kAnySurvivor),
      crossover_(config.crossover == "one_point" ? Crossover::kOnePoint
                 : config.crossover == "uniform" ? Crossover::kUniform
                 : config.crossover == "gene"    ? Crossover::kGene
                                                 : Crossover::kTwoPoint),
      mutation_(config.mutation == "each_bit"   ? Mutation::kEachBit
                : config.mutation == "one_gene" ? Mutation::kOneGene
                                                : Mutation::kOneBit),
      random_(seed),
      individuals_(static_cast<std::size_t>(std::max(config.population, 4))),
      asked_(individuals_.size()) {
  reset(seed);
}

void RmGa::reset(std::uint64_t seed) {
  random_.seed(seed);
  for (Individual& i : individuals_) i = {draw(), kNoScore, false};
  forget_best();
  write_candidates();
}

void RmGa::begin_frame(std::span<const float> hint) {
  take_scores();  // of the generation that the last frame's end cut off
  for (Individual& i : individuals_) i.scored = false;
  if (use_hint_ && !hint.empty()) {
    sort();
    individuals_.back() = {coding_.encode(hint), kNoScore, false};
  }
  forget_best_score();
  write_candidates();
}

void RmGa::evolve() {
  take_scores();
  sort();
  replace_the_weak();
  write_candidates();
}

void RmGa::take_scores() {
  for (int i = 0; i < scored_count(); ++i) {
    Individual& asked = individuals_[static_cast<std::size_t>(asked_[static_cast<std::size_t>(i)])];
    asked.score = candidate_score(i);
    asked.scored = true;
  }
}

void RmGa::sort() {
  // A total order (equal scores by chromosome), so that every standard library sorts alike.
  std::sort(individuals_.begin(), individuals_.end(), [](const Individual& a, const Individual& b) {
    return a.score != b.score ? a.score > b.score : a.chromosome.codes < b.chromosome.codes;
  });
}

void RmGa::replace_the_weak() {
  const int population = static_cast<int>(individuals_.size());
  for (int i = survivors_; i < population; i += 2) {
    const int first = parent(true);
    const int second = parent(false);
    Chromosome a = individuals_[static_cast<std::size_t>(first)].chromosome;
    Chromosome b = individuals_[static_cast<std::size_t>(second)].chromosome;
    cross(a, b);
    mutate(a);
    mutate(b);
    individuals_[static_cast<std::size_t>(i)] = {a, kNoScore, false};
    if (i + 1 < population) individuals_[static_cast<std::size_t>(i + 1)] = {b, kNoScore, false};
  }
  if (!mutate_survivors_) return;
  for (int i = elite_; i < survivors_; ++i) {
    Individual& survivor = individuals_[static_cast<std::size_t>(i)];
    const Chromosome before = survivor.chromosome;
    mutate(survivor.chromosome);
    if (!(survivor.chromosome == before)) survivor.scored = false;
  }
}

int RmGa::parent(bool first) {
  switch (parents_) {
    case Parents::kAnySurvivor:
      return random_.below(survivors_);
    // The better of two draws: linear in rank.
    case Parents::kRanked:
      return std::min(random_.below(survivors_), random_.below(survivors_));
    case Parents::kBestWithSurvivor:
      return first ? 0 : random_.below(survivors_);
  }
  return 0;
}

void RmGa::cross(Chromosome& a, Chromosome& b) {
  const int bits = coding_.bits();
  switch (crossover_) {
    case Crossover::kOnePoint:
      coding_.exchange(a, b, 1 + random_.below(std::max(bits - 1, 1)), bits);
      return;
    case Crossover::kTwoPoint: {
      const int one = random_.below(bits);
      const int two = random_.below(bits);
      coding_.exchange(a, b, std::min(one, two), std::max(one, two) + 1);
      return;
    }
    case Crossover::kUniform:
      for (int i = 0; i < bits; ++i) {
        if (random_.below(2) == 1) coding_.exchange(a, b, i, i + 1);
      }
      return;
    case Crossover::kGene:
      for (std::size_t i = 0; i < static_cast<std::size_t>(coding_.variables()); ++i) {
        if (random_.below(2) == 1) std::swap(a.codes[i], b.codes[i]);
      }
      return;
  }
}

void RmGa::mutate(Chromosome& c) {
  if (mutation_ == Mutation::kEachBit) {
    for (int i = 0; i < coding_.bits(); ++i) {
      if (random_.uniform() < mutation_rate_) coding_.flip(c, i);
    }
    return;
  }
  if (random_.uniform() >= mutation_rate_) return;
  if (mutation_ == Mutation::kOneBit) {
    coding_.flip(c, random_.below(coding_.bits()));
  } else {
    const std::size_t i = static_cast<std::size_t>(random_.below(coding_.variables()));
    c.codes[i] = draw().codes[i];
  }
}

Chromosome RmGa::draw() {
  Chromosome c;
  for (int i = 0; i < coding_.variables(); ++i) {
    c.codes[static_cast<std::size_t>(i)] =
        static_cast<std::uint16_t>(random_.below(1 << coding_.bits(i)));
  }
  return c;
}

void RmGa::write_candidates() {
  clear_candidates();
  for (std::size_t i = 0; i < individuals_.size(); ++i) {
    if (individuals_[i].scored && !score_survivors_again_) continue;
    asked_[static_cast<std::size_t>(candidate_count())] = static_cast<int>(i);
    coding_.decode(individuals_[i].chromosome, add_candidate());
  }
}

}  // namespace gannet::search
