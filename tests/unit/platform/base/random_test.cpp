#include "platform/base/random.hpp"

#include <gtest/gtest.h>

#include <array>

namespace gannet {
namespace {

TEST(Random, same_seed_same_numbers_other_seed_others) {
  Random a(5), b(5), c(6);
  bool differs = false;
  for (int i = 0; i < 100; ++i) {
    const auto x = a.next();
    EXPECT_EQ(x, b.next());
    differs |= x != c.next();
  }
  EXPECT_TRUE(differs);
}

TEST(Random, numbers_are_spread_evenly) {
  Random sut(7);
  std::array<int, 10> counts = {};
  for (int i = 0; i < 100000; ++i) ++counts[static_cast<std::size_t>(sut.below(10))];
  for (const int count : counts) EXPECT_NEAR(count, 10000, 500);
}

TEST(Random, normal_has_mean_zero_and_variance_one) {
  Random sut(8);
  double sum = 0, squares = 0;
  for (int i = 0; i < 100000; ++i) {
    const double x = sut.normal_f();
    sum += x;
    squares += x * x;
  }
  EXPECT_NEAR(sum / 100000, 0, 0.02);
  EXPECT_NEAR(squares / 100000, 1, 0.03);
}

}  // namespace
}  // namespace gannet
