#include "src/search/differential_evolution.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tests/unit/src/search/problems.hpp"

namespace gannet::search {
namespace {

const Problem kProblem{{0.3f, 0.6f, 0.45f, 0.7f, 0.2f, 0.55f}, 0};

std::vector<std::vector<float>> candidates(Optimiser& sut, int evaluations) {
  std::vector<float> seen;
  search(sut, kProblem, evaluations, 60, &seen);
  std::vector<std::vector<float>> result;
  for (std::size_t i = 0; i < seen.size(); i += 6) {
    result.emplace_back(seen.begin() + static_cast<long>(i),
                        seen.begin() + static_cast<long>(i + 6));
  }
  return result;
}

TEST(DifferentialEvolution, members_are_scored_again_when_a_frame_begins) {
  DifferentialEvolutionConfig config;
  config.reseed_share = 0;
  DifferentialEvolution sut(6, config, 1);
  const auto first = candidates(sut, 60);
  sut.begin_frame({});
  EXPECT_EQ(candidates(sut, 60), first);
}

TEST(DifferentialEvolution, the_worst_part_is_reseeded_half_locally_half_anywhere) {
  DifferentialEvolution sut(6, {}, 1);
  auto before = candidates(sut, 60);
  std::array<float, 6> best;
  sut.best(best);
  sut.begin_frame({});
  const auto after = candidates(sut, 60);
  const std::set<std::vector<float>> old(before.begin(), before.end());
  int kept = 0;
  int local = 0;
  for (const auto& genes : after) {
    if (old.count(genes) == 1) {
      ++kept;
    } else if (distance(genes, best) <= 0.05f) {
      ++local;
    }
  }
  EXPECT_EQ(kept, 40);
  EXPECT_EQ(local, 10);
  // The 40 that stayed are the 40 best.
  std::sort(before.begin(), before.end(),
            [](const auto& a, const auto& b) { return kProblem(a) > kProblem(b); });
  const std::set<std::vector<float>> now(after.begin(), after.end());
  for (std::size_t i = 0; i < 40; ++i) EXPECT_EQ(now.count(before[i]), 1u) << i;
}

TEST(DifferentialEvolution, local_members_gather_about_the_hint) {
  DifferentialEvolution sut(6, {}, 1);
  candidates(sut, 600);
  const std::vector<float> hint = {0.8f, 0.1f, 0.9f, 0.2f, 0.8f, 0.1f};
  sut.begin_frame(hint);
  int near = 0;
  bool itself = false;
  for (const auto& genes : candidates(sut, 60)) {
    near += distance(genes, hint) <= 0.0501f ? 1 : 0;
    itself = itself || genes == hint;
  }
  EXPECT_EQ(near, 10);
  EXPECT_TRUE(itself);
}

TEST(DifferentialEvolution, what_a_cut_off_generation_found_is_not_lost) {
  DifferentialEvolution sut(6, {}, 1);
  candidates(sut, 60 + 30);  // half of the first trials
  std::array<float, 6> best;
  sut.best(best);
  sut.begin_frame({});
  const auto after = candidates(sut, 60);
  EXPECT_EQ(std::count(after.begin(), after.end(), std::vector<float>(best.begin(), best.end())),
            1);
}

TEST(DifferentialEvolution, the_strategies_differ) {
  std::set<std::vector<std::vector<float>>> different;
  for (const char* strategy : {"mix", "rand_1", "current_to_best"}) {
    DifferentialEvolutionConfig config;
    config.strategy = strategy;
    DifferentialEvolution sut(6, config, 1);
    different.insert(candidates(sut, 240));
  }
  EXPECT_EQ(different.size(), 3u);
}

}  // namespace
}  // namespace gannet::search
