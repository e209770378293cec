#include "src/search/population.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace gannet::search {
namespace {

TEST(Population, ranks_best_first_and_equals_by_index) {
  Population sut(5, 1);
  const std::array<float, 5> scores = {1, 3, kNoScore, 3, 2};
  for (int i = 0; i < 5; ++i) sut.set_score(i, scores[static_cast<std::size_t>(i)]);
  sut.rank();
  const std::array<int, 5> expected = {1, 3, 4, 0, 2};
  for (int k = 0; k < 5; ++k) EXPECT_EQ(sut.ranked(k), expected[static_cast<std::size_t>(k)]);
  sut.rank(3);
  EXPECT_EQ(sut.ranked(0), 1);
  EXPECT_EQ(sut.ranked(2), 2);
}

TEST(Fold, mirrors_at_both_ends) {
  EXPECT_FLOAT_EQ(fold(0.25f), 0.25f);
  EXPECT_FLOAT_EQ(fold(-0.25f), 0.25f);
  EXPECT_FLOAT_EQ(fold(1.25f), 0.75f);
  EXPECT_FLOAT_EQ(fold(2.25f), 0.25f);
  EXPECT_FLOAT_EQ(fold(-1.25f), 0.75f);
  EXPECT_EQ(fold(0), 0);
  EXPECT_EQ(fold(1), 1);
}

TEST(Fold, answers_inside_for_anything) {
  for (const float x : {std::nanf(""), INFINITY, -INFINITY, 3e38f, -3e38f, 999999.9f}) {
    EXPECT_TRUE(fold(x) >= 0 && fold(x) <= 1) << x;
  }
}

TEST(DrawNear, stays_within_the_radius_and_the_box) {
  Random random(3);
  const std::array<float, 2> centre = {0.01f, 0.5f};
  for (int i = 0; i < 1000; ++i) {
    std::array<float, 2> genes;
    draw_near(random, centre, 0.1f, genes);
    EXPECT_TRUE(genes[0] >= 0 && genes[0] <= 0.11f);
    EXPECT_NEAR(genes[1], 0.5f, 0.1001f);
  }
}

}  // namespace
}  // namespace gannet::search
