#include "src/report/statistics.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace gannet::report {
namespace {

constexpr std::array<double, 5> kValues = {4, 1, 3, 2, 10};

TEST(Statistics, mean_rms_and_deviation) {
  EXPECT_DOUBLE_EQ(mean(kValues), 4);
  EXPECT_DOUBLE_EQ(rms(kValues), std::sqrt(130.0 / 5));
  EXPECT_DOUBLE_EQ(standard_deviation(kValues), std::sqrt(50.0 / 4));
}

TEST(Statistics, percentiles_are_linear_between_ranks) {
  EXPECT_DOUBLE_EQ(percentile(kValues, 0), 1);
  EXPECT_DOUBLE_EQ(percentile(kValues, 50), 3);
  EXPECT_DOUBLE_EQ(percentile(kValues, 25), 2);
  EXPECT_DOUBLE_EQ(percentile(kValues, 90), 4 + 0.6 * 6);
  EXPECT_DOUBLE_EQ(percentile(kValues, 100), 10);
}

TEST(Statistics, an_empty_sample_is_not_a_number) {
  const Summary sut = summarise({});
  EXPECT_EQ(sut.count, 0);
  for (const double v : {sut.mean, sut.rms, sut.deviation, sut.min, sut.p50, sut.p99, sut.max}) {
    EXPECT_TRUE(std::isnan(v));
  }
}

TEST(Statistics, one_value_is_its_own_summary) {
  const std::array<double, 1> one = {7};
  const Summary sut = summarise(one);
  EXPECT_EQ(sut.min, 7);
  EXPECT_EQ(sut.p90, 7);
  EXPECT_EQ(sut.max, 7);
  EXPECT_EQ(sut.deviation, 0);
}

// Worked out by hand from the formula; 8 of 10 is the usual textbook example.
TEST(Wilson, agrees_with_published_values) {
  EXPECT_NEAR(wilson95(8, 10).low, 0.4902, 1e-4);
  EXPECT_NEAR(wilson95(8, 10).high, 0.9433, 1e-4);
  EXPECT_NEAR(wilson95(95, 100).low, 0.8882, 1e-4);
  EXPECT_NEAR(wilson95(95, 100).high, 0.9785, 1e-4);
}

TEST(Wilson, is_never_empty_and_never_beyond_the_ends) {
  EXPECT_EQ(wilson95(0, 20).low, 0);
  EXPECT_NEAR(wilson95(0, 20).high, 0.1611, 1e-4);
  EXPECT_EQ(wilson95(20, 20).high, 1);
  EXPECT_NEAR(wilson95(20, 20).low, 0.8389, 1e-4);
  EXPECT_EQ(wilson95(0, 0).low, 0);
  EXPECT_EQ(wilson95(0, 0).high, 1);
}

// Half the quantiles of chi-square, as tables give them.
TEST(Poisson, agrees_with_published_values) {
  EXPECT_EQ(poisson95(0).low, 0);
  EXPECT_NEAR(poisson95(0).high, 3.689, 1e-3);
  EXPECT_NEAR(poisson95(1).low, 0.0253, 1e-4);
  EXPECT_NEAR(poisson95(1).high, 5.572, 1e-3);
  EXPECT_NEAR(poisson95(10).low, 4.795, 1e-3);
  EXPECT_NEAR(poisson95(10).high, 18.390, 1e-3);
}

TEST(Statistics, the_mean_of_few_values_has_students_interval) {
  const MeanInterval three = mean95(std::array<double, 3>{1, 2, 3});
  EXPECT_NEAR(three.low, 2 - 4.3027 / std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(three.high, 2 + 4.3027 / std::sqrt(3.0), 1e-9);
  std::array<double, 31> many = {};
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = static_cast<double>(i % 2);
  // 30 degrees of freedom: t = 2.0423.
  const double half = mean95(many).high - mean(many);
  EXPECT_NEAR(half, 2.0423 * standard_deviation(many) / std::sqrt(31.0), 1e-4);
  EXPECT_TRUE(std::isnan(mean95(std::array<double, 1>{5}).low));
}

}  // namespace
}  // namespace gannet::report
