#include "src/report/plot_axis.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "platform/base/random.hpp"

namespace gannet::report {
namespace {

TEST(PlotAxis, ticks_are_round_and_labelled_with_just_enough_decimals) {
  const PlotAxis sut({-0.013, 0.048}, 0, 100, 6, true);
  std::vector<std::string> labels;
  for (const double tick : sut.ticks()) labels.push_back(sut.label(tick));
  EXPECT_EQ(labels, (std::vector<std::string>{"−0.02", "0.00", "0.02", "0.04", "0.06"}));
}

TEST(PlotAxis, maps_the_range_onto_the_pixels_both_ways_round) {
  const PlotAxis up({0, 10}, 200, 100, 5, false);
  EXPECT_DOUBLE_EQ(up.pixel(0), 200);
  EXPECT_DOUBLE_EQ(up.pixel(10), 100);
  EXPECT_DOUBLE_EQ(up.pixel(2.5), 175);
}

TEST(PlotAxis, any_range_has_a_few_ticks_inside_it) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const double scale = std::pow(10, 24 * random.uniform() - 12);
    const double low = scale * (random.uniform() - 0.5);
    const double high = low + scale * random.uniform();
    const PlotAxis sut({low, high}, 0, 100, 5, i % 2 == 0);
    ASSERT_GE(sut.ticks().size(), 2u) << low << " " << high;
    ASSERT_LE(sut.ticks().size(), 9u) << low << " " << high;
    for (const double tick : sut.ticks()) {
      ASSERT_GE(sut.pixel(tick), -0.1);
      ASSERT_LE(sut.pixel(tick), 100.1);
    }
  }
}

TEST(PlotAxis, empty_and_wild_ranges_are_made_usable) {
  for (const Range range : {Range{3, 3}, Range{0, 0}, Range{2, 1}, Range{NAN, 1},
                            Range{-INFINITY, INFINITY}, Range{1e17, 1e17}}) {
    const PlotAxis sut(range, 0, 100, 5, true);
    EXPECT_GE(sut.ticks().size(), 2u);
    EXPECT_LE(sut.ticks().size(), 12u);
    EXPECT_TRUE(std::isfinite(sut.pixel(sut.ticks()[0])));
  }
}

TEST(RoundStep, is_the_next_of_one_two_five) {
  EXPECT_DOUBLE_EQ(round_step(1), 1);
  EXPECT_DOUBLE_EQ(round_step(1.01), 2);
  EXPECT_DOUBLE_EQ(round_step(0.021), 0.05);
  EXPECT_DOUBLE_EQ(round_step(51), 100);
}

}  // namespace
}  // namespace gannet::report
