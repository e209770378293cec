// What every optimiser promises (optimiser.hpp), asked of each kind.
#include "src/search/optimiser_kinds.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "src/search/population.hpp"
#include "tests/unit/src/search/heap_count.hpp"
#include "tests/unit/src/search/problems.hpp"

namespace gannet::search {
namespace {

std::unique_ptr<Optimiser> make(std::string_view name, int dimension, std::uint64_t seed,
                                const SearchConfig& config = {}) {
  auto result = make_optimiser(name, dimension, config, seed);
  EXPECT_TRUE(result) << result.error().text;
  return std::move(result).value();
}

TEST(OptimiserKinds, an_unknown_name_is_refused_with_the_known_ones) {
  const auto result = make_optimiser("hill_climb", 6, {}, 1);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().text.find("hill_climb"), std::string::npos);
  for (const std::string& name : optimiser_names()) {
    EXPECT_NE(result.error().text.find(name), std::string::npos) << name;
  }
}

TEST(OptimiserKinds, a_dimension_outside_is_refused) {
  EXPECT_FALSE(make_optimiser("cma_es", 0, {}, 1));
  EXPECT_FALSE(make_optimiser("cma_es", 9, {}, 1));
}

class EveryOptimiser : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Kinds, EveryOptimiser, testing::ValuesIn(optimiser_names()),
                         [](const auto& kind) { return kind.param; });

const Problem kProblem{{0.3f, 0.6f, 0.45f, 0.7f, 0.2f, 0.55f}, 0.03f};

std::vector<float> candidates_of_two_frames(Optimiser& sut, int portion) {
  std::vector<float> seen;
  search(sut, kProblem, 500, portion, &seen);
  sut.begin_frame({});
  search(sut, kProblem, 700, portion, &seen);
  return seen;
}

TEST_P(EveryOptimiser, repeats_itself_for_the_same_seed) {
  auto a = make(GetParam(), 6, 7);
  auto b = make(GetParam(), 6, 7);
  const std::vector<float> first = candidates_of_two_frames(*a, 32);
  EXPECT_EQ(first, candidates_of_two_frames(*b, 32));
  a->reset(7);
  EXPECT_EQ(first, candidates_of_two_frames(*a, 32));
  a->reset(8);
  EXPECT_NE(first, candidates_of_two_frames(*a, 32));
}

TEST_P(EveryOptimiser, does_not_care_how_large_the_portions_are) {
  auto a = make(GetParam(), 6, 7);
  auto b = make(GetParam(), 6, 7);
  EXPECT_EQ(candidates_of_two_frames(*a, 1), candidates_of_two_frames(*b, 500));
}

TEST_P(EveryOptimiser, stays_in_the_unit_box_also_where_the_peak_lies_in_a_corner) {
  const Problem corner{{0, 0, 1, 1, 0, 1}, 0};
  auto sut = make(GetParam(), 6, 3);
  std::vector<float> seen;
  search(*sut, corner, 3000, 50, &seen);
  for (const float gene : seen) {
    ASSERT_GE(gene, 0);
    ASSERT_LE(gene, 1);
  }
}

TEST_P(EveryOptimiser, takes_no_heap_after_creation) {
  auto sut = make(GetParam(), 6, 3);
  std::array<float, 6 * 40> genes;
  std::array<float, 40> scores;
  std::array<float, 6> hint = {0.3f, 0.6f, 0.45f, 0.7f, 0.2f, 0.55f};
  const long before = heap_count();
  for (int frame = 0; frame < 6; ++frame) {
    if (frame > 0)
      sut->begin_frame(frame % 2 == 0 ? std::span<const float>(hint) : std::span<const float>());
    for (int round = 0; round < 50; ++round) {
      const std::size_t n = static_cast<std::size_t>(sut->propose(genes));
      for (std::size_t i = 0; i < n; ++i) {
        scores[i] = kProblem(std::span<const float>(genes).subspan(6 * i, 6));
      }
      sut->learn(std::span<const float>(scores).first(n));
    }
    sut->best(hint);
  }
  sut->reset(5);
  EXPECT_EQ(heap_count(), before);
}

TEST_P(EveryOptimiser, survives_scores_that_are_not_numbers) {
  auto sut = make(GetParam(), 6, 3);
  const auto bad = [](std::span<const float>) { return std::nanf(""); };
  std::vector<float> seen;
  const Answer answer = search(*sut, bad, 400, 30, &seen);
  EXPECT_EQ(answer.score, kNoScore);
  for (const float gene : seen) ASSERT_TRUE(gene >= 0 && gene <= 1);
  sut->begin_frame({});
  EXPECT_GT(search(*sut, kProblem, 2000).score, 0.0f);
}

TEST_P(EveryOptimiser, is_made_for_one_to_eight_genes) {
  for (int n = 1; n <= 8; ++n) {
    const Problem problem{std::vector<float>(static_cast<std::size_t>(n), 0.4f), 0};
    auto sut = make(GetParam(), n, 3);
    EXPECT_EQ(sut->dimension(), n);
    EXPECT_LT(distance(search(*sut, problem, 5000).genes, problem.centre), 0.12f) << n;
  }
}

// ---- what holds for the three kinds that score every candidate alike
// ------------------------------

class PlainOptimiser : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Kinds, PlainOptimiser,
                         testing::Values("rm_ga", "differential_evolution", "cma_es"),
                         [](const auto& kind) { return std::string(kind.param); });

TEST_P(PlainOptimiser, depends_on_the_order_of_the_scores_only) {
  auto a = make(GetParam(), 6, 11);
  auto b = make(GetParam(), 6, 11);
  std::vector<float> seen_a;
  std::vector<float> seen_b;
  search(*a, kProblem, 1500, 64, &seen_a);
  // A bent scale; powers of two are exact, so that no two scores fall together.
  search(
      *b,
      [](std::span<const float> g) {
        const float s = kProblem(g);
        return s > 0 ? s * 4 : s / 4;
      },
      1500, 64, &seen_b);
  EXPECT_EQ(seen_a, seen_b);
}

TEST_P(PlainOptimiser, best_is_the_best_that_was_learnt_in_this_frame) {
  auto sut = make(GetParam(), 6, 5);
  std::array<float, 6> genes;
  EXPECT_EQ(sut->best(genes), kNoScore);
  for (int frame = 0; frame < 3; ++frame) {
    if (frame > 0) sut->begin_frame({});
    EXPECT_EQ(sut->best(genes), kNoScore) << "a new frame has no score yet";
    // The score counts up, then down: the best is the one in the middle.
    int k = 0;
    std::vector<float> middle;
    const auto score = [&](std::span<const float> g) {
      if (++k == 130) middle.assign(g.begin(), g.end());
      return -std::abs(static_cast<float>(k - 130));
    };
    const Answer answer = search(*sut, score, 200, 17);
    EXPECT_EQ(answer.score, 0.0f);
    EXPECT_EQ(answer.genes, middle);
  }
}

TEST_P(PlainOptimiser, proposes_again_what_a_deadline_left_unscored) {
  auto a = make(GetParam(), 6, 5);
  auto b = make(GetParam(), 6, 5);
  std::array<float, 6 * 5> genes_a;
  std::array<float, 6 * 5> genes_b;
  ASSERT_EQ(a->propose(genes_a), 5);
  ASSERT_EQ(b->propose(genes_b), 5);
  const std::array<float, 2> two = {0.1f, 0.2f};
  a->learn(two);
  ASSERT_EQ(a->propose(genes_a), 5);
  EXPECT_TRUE(std::equal(genes_a.begin(), genes_a.begin() + 18, genes_b.begin() + 12));
}

TEST_P(PlainOptimiser, scores_the_hint_itself_early_in_the_frame) {
  SearchConfig config;
  config.rm_ga.use_hint = true;
  auto sut = make(GetParam(), 6, 5, config);
  search(*sut, kProblem, 300);
  const std::vector<float> hint = {0.9f, 0.05f, 0.8f, 0.12f, 0.77f, 0.1f};
  sut->begin_frame(hint);
  std::vector<float> seen;
  search(*sut, kProblem, 60, 60, &seen);
  float nearest = 1;
  for (std::size_t i = 0; i + 6 <= seen.size(); i += 6) {
    nearest = std::min(nearest, distance(std::span<const float>(seen).subspan(i, 6), hint));
  }
  EXPECT_LT(nearest, 1.0f / 4095);  // the coarsest coding
}

TEST_P(PlainOptimiser, a_hint_beyond_the_box_does_no_harm) {
  SearchConfig config;
  config.rm_ga.use_hint = true;
  auto sut = make(GetParam(), 6, 5, config);
  const std::vector<float> hint = {-0.2f, 1.4f, std::nanf(""), INFINITY, -1e30f, 0.5f};
  sut->begin_frame(hint);
  std::vector<float> seen;
  search(*sut, kProblem, 300, 30, &seen);
  for (const float gene : seen) ASSERT_TRUE(gene >= 0 && gene <= 1) << gene;
}

}  // namespace
}  // namespace gannet::search
