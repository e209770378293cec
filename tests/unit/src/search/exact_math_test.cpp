#include "src/search/exact_math.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace gannet::search {
namespace {

TEST(ExactMath, exp_agrees_with_the_library) {
  for (double x = -20; x <= 20; x += 0.0137) {
    EXPECT_NEAR(exact_exp(x) / std::exp(x), 1, 1e-13) << x;
  }
}

TEST(ExactMath, log_agrees_with_the_library) {
  for (double x = 1e-6; x <= 1e6; x *= 1.0137) EXPECT_NEAR(exact_log(x), std::log(x), 1e-14) << x;
  EXPECT_EQ(exact_log(1), 0);
}

TEST(ExactMath, what_is_outside_is_clamped) {
  EXPECT_EQ(exact_exp(1000), exact_exp(20));
  EXPECT_EQ(exact_log(0), exact_log(1e-6));
}

}  // namespace
}  // namespace gannet::search
