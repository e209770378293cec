#include "src/search/gannet_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/src/search/heap_count.hpp"

namespace gannet::search {
namespace {

constexpr std::array<double, 3> kCost = {1, 0.3, 0.05};

// Two peaks: on coarse levels the wrong one looks higher; only the full one tells them apart.
struct TwoPeaks {
  std::vector<float> right = {0.7f, 0.3f, 0.6f, 0.4f, 0.5f, 0.55f};
  std::vector<float> wrong = {0.2f, 0.8f, 0.3f, 0.7f, 0.6f, 0.35f};
  static double peak(std::span<const float> g, const std::vector<float>& at, double width) {
    double square = 0;
    for (std::size_t i = 0; i < g.size(); ++i) {
      const double d = static_cast<double>(g[i] - at[i]);
      square += d * d;
    }
    return 1 / (1 + square / (width * width));
  }
  float operator()(std::span<const float> g, int level) const {
    const double width = 0.12 * (1 + level);
    const double lie = level == 0 ? 0.8 : 1.05;
    return static_cast<float>(std::max(peak(g, right, width), lie * peak(g, wrong, width)));
  }
};

struct Outcome {
  std::array<float, 6> best = {};
  float score = 0;
  double spent = 0;
  std::vector<int> levels;  // as they came
};

template <class Scores>
Outcome run(GannetSearch& sut, const Scores& problem, double evaluations, std::size_t portion,
            std::span<const float> hint = {}) {
  Outcome out;
  sut.plan(evaluations, kCost);
  sut.begin_frame(hint);
  std::vector<float> genes(6 * portion), scores(portion);
  while (out.spent < evaluations) {
    const int level = sut.level();
    if (out.levels.empty() || out.levels.back() != level) out.levels.push_back(level);
    const int n = sut.propose(genes);
    for (int i = 0; i < n; ++i) {
      scores[static_cast<std::size_t>(i)] =
          problem(std::span<const float>(genes).subspan(static_cast<std::size_t>(6 * i), 6), level);
    }
    sut.learn({scores.data(), static_cast<std::size_t>(n)});
    out.spent += n * kCost[static_cast<std::size_t>(level)];
  }
  out.score = sut.best(out.best);
  return out;
}

float apart(const std::array<float, 6>& a, const std::vector<float>& b) {
  float most = 0;
  for (std::size_t i = 0; i < 6; ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

TEST(GannetSearch, goes_from_the_coarsest_level_to_the_full_one) {
  GannetSearch sut(6, {}, 1);
  const Outcome got = run(sut, TwoPeaks{}, 8000, 256);
  EXPECT_EQ(got.levels, (std::vector<int>{2, 1, 0}));
}

TEST(GannetSearch, keeps_the_hypothesis_that_only_the_full_level_prefers) {
  int right = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    GannetSearch sut(6, {}, seed);
    const TwoPeaks problem;
    const Outcome got = run(sut, problem, 8000, 256);
    right += apart(got.best, problem.right) < 0.02f;
  }
  EXPECT_GE(right, 39);  // a single population that trusts the coarse level would get none
}

TEST(GannetSearch, answers_the_same_for_every_portion) {
  GannetSearch a(6, {}, 5), b(6, {}, 5);
  EXPECT_EQ(run(a, TwoPeaks{}, 5000, 512).best, run(b, TwoPeaks{}, 5000, 64).best);
}

TEST(GannetSearch, keeps_its_plan_within_a_generation) {
  for (const double evaluations : {300.0, 2000.0, 20000.0}) {
    GannetSearch sut(6, {}, 1);
    const Outcome got = run(sut, TwoPeaks{}, evaluations, 128);
    EXPECT_EQ(got.levels.back(), 0) << evaluations;
    EXPECT_LT(got.spent, evaluations + 128);
  }
}

TEST(GannetSearch, needs_little_where_the_hint_is_good) {
  const TwoPeaks problem;
  std::vector<float> hint = problem.right;
  for (float& g : hint) g += 0.02f;
  int right = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    GannetSearch sut(6, {}, seed);
    right += apart(run(sut, problem, 600, 256, hint).best, problem.right) < 0.02f;
  }
  EXPECT_EQ(right, 40);
}

TEST(GannetSearch, leaves_a_hint_that_is_wrong) {
  const TwoPeaks problem;
  int right = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    GannetSearch sut(6, {}, seed);
    right += apart(run(sut, problem, 8000, 256, problem.wrong).best, problem.right) < 0.02f;
  }
  EXPECT_GE(right, 38);
}

TEST(GannetSearch, takes_no_heap_after_creation) {
  GannetSearch sut(6, {}, 1);
  std::array<float, 6 * 256> genes;
  std::array<float, 256> scores;
  const TwoPeaks problem;
  const long before = heap_count();
  for (int frame = 0; frame < 3; ++frame) {
    sut.plan(3000, kCost);
    sut.begin_frame({});
    for (int round = 0; round < 100; ++round) {
      const int level = sut.level();
      const int n = sut.propose(genes);
      for (int i = 0; i < n; ++i) {
        const auto at = static_cast<std::size_t>(i);
        scores[at] = problem(std::span<const float>(genes).subspan(6 * at, 6), level);
      }
      sut.learn({scores.data(), static_cast<std::size_t>(n)});
    }
  }
  EXPECT_EQ(heap_count(), before);
}

}  // namespace
}  // namespace gannet::search
