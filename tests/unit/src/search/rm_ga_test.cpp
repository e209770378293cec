#include "src/search/rm_ga.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tests/unit/src/search/problems.hpp"

namespace gannet::search {
namespace {

const Problem kProblem{{0.3f, 0.6f, 0.45f, 0.7f, 0.2f, 0.55f}, 0.03f};

// One generation: the candidates that were asked for.
std::vector<std::vector<float>> generation(RmGa& sut) {
  std::vector<float> genes(6 * 1000);
  const std::size_t n = static_cast<std::size_t>(sut.propose(genes));
  std::vector<std::vector<float>> result;
  std::vector<float> scores;
  for (std::size_t i = 0; i < n; ++i) {
    result.emplace_back(genes.begin() + static_cast<long>(6 * i),
                        genes.begin() + static_cast<long>(6 * i + 6));
    scores.push_back(kProblem(result.back()));
  }
  sut.learn(scores);
  return result;
}

TEST(RmGa, scores_the_whole_population_in_every_generation_as_published) {
  RmGa sut(6, {}, 1);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(generation(sut).size(), 60u);  // 540 in a frame of nine
}

TEST(RmGa, can_score_only_the_children) {
  RmGaConfig config;
  config.score_survivors_again = false;
  config.mutate_survivors = false;
  RmGa sut(6, config, 1);
  EXPECT_EQ(generation(sut).size(), 60u);
  EXPECT_EQ(generation(sut).size(), 24u);
  sut.begin_frame({});
  EXPECT_EQ(generation(sut).size(), 60u);  // the old scores are stale
}

TEST(RmGa, the_strong_survive_unchanged_and_the_weak_go) {
  RmGaConfig config;
  config.mutate_survivors = false;
  RmGa sut(6, config, 1);
  std::vector<std::vector<float>> before = generation(sut);
  const auto stronger = [](const auto& a, const auto& b) { return kProblem(a) > kProblem(b); };
  std::sort(before.begin(), before.end(), stronger);
  const std::vector<std::vector<float>> after = generation(sut);
  const std::set<std::vector<float>> there(after.begin(), after.end());
  for (std::size_t i = 0; i < 36; ++i) EXPECT_EQ(there.count(before[i]), 1u) << i;
  int weak = 0;
  for (std::size_t i = 36; i < 60; ++i) weak += static_cast<int>(there.count(before[i]));
  EXPECT_EQ(weak, 0);
}

TEST(RmGa, without_mutation_children_have_only_their_parents_bits) {
  RmGaConfig config;
  config.mutation_rate = 0;
  config.crossover = "gene";
  RmGa sut(6, config, 1);
  const std::vector<std::vector<float>> parents = generation(sut);
  for (const auto& child : generation(sut)) {
    for (std::size_t gene = 0; gene < 6; ++gene) {
      bool inherited = false;
      for (const auto& parent : parents) inherited = inherited || parent[gene] == child[gene];
      EXPECT_TRUE(inherited);
    }
  }
}

TEST(RmGa, the_elite_is_never_mutated) {
  RmGaConfig config;
  config.mutation_rate = 1;
  RmGa sut(6, config, 1);
  float best = kNoScore;
  for (int i = 0; i < 20; ++i) {
    float best_here = kNoScore;
    for (const auto& genes : generation(sut)) best_here = std::max(best_here, kProblem(genes));
    EXPECT_GE(best_here, best);
    best = best_here;
  }
}

TEST(RmGa, mutation_of_one_bit_changes_at_most_one_bit_of_a_child) {
  RmGaConfig config;
  config.mutation = "one_bit";
  config.mutation_rate = 1;
  config.mutate_survivors = false;
  config.crossover = "gene";
  config.parents = "any_survivor";
  RmGa sut(6, config, 1);
  const std::vector<std::vector<float>> parents = generation(sut);
  const std::vector<std::vector<float>> after = generation(sut);
  for (const auto& child : after) {
    int foreign = 0;
    for (std::size_t gene = 0; gene < 6; ++gene) {
      bool inherited = false;
      for (const auto& parent : parents) inherited = inherited || parent[gene] == child[gene];
      foreign += inherited ? 0 : 1;
    }
    EXPECT_LE(foreign, 1);
  }
  EXPECT_NE(parents, after);
}

TEST(RmGa, three_genes_are_coded_in_24_bits) {
  RmGa sut(3, {}, 1);
  std::vector<float> genes(3 * 60);
  ASSERT_EQ(sut.propose(genes), 60);
  for (std::size_t i = 0; i < genes.size(); ++i) {
    const float last = i % 3 == 0 ? 1023 : 127;
    EXPECT_NEAR(genes[i] * last, std::round(genes[i] * last), 1e-3f);
  }
}

TEST(RmGa, every_choice_of_the_config_changes_the_search) {
  std::vector<RmGaConfig> configs(10);
  configs[1].coding = "gray";
  configs[2].parents = "ranked";
  configs[3].parents = "best_with_survivor";
  configs[4].crossover = "one_point";
  configs[5].crossover = "uniform";
  configs[6].crossover = "gene";
  configs[7].mutation = "one_bit";
  configs[8].mutation = "one_gene";
  configs[9].mutate_survivors = false;
  std::set<std::vector<float>> different;
  for (const RmGaConfig& config : configs) {
    RmGa sut(6, config, 1);
    std::vector<float> seen;
    search(sut, kProblem, 600, 60, &seen);
    different.insert(seen);
  }
  EXPECT_EQ(different.size(), configs.size());
}

}  // namespace
}  // namespace gannet::search
