#include "src/vision/hue_value.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "platform/base/random.hpp"
#include "src/vision/yuv_rows.hpp"

namespace gannet::vision {
namespace {

// HSV from RGB by the textbook, hue in 256 steps.
struct Hsv {
  double hue, value, chroma;
};
Hsv hsv_of(double r, double g, double b) {
  const double high = std::max({r, g, b});
  const double low = std::min({r, g, b});
  const double chroma = high - low;
  double h = 0;
  if (chroma > 0) {
    if (high == r) h = std::fmod((g - b) / chroma + 6, 6);
    if (high == g && high != r) h = (b - r) / chroma + 2;
    if (high == b && high != r && high != g) h = (r - g) / chroma + 4;
  }
  return {h * 256 / 6, high, chroma};
}

TEST(HueValue, agrees_with_hsv_of_rgb_where_there_is_chroma) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const int r = random.below(256), g = random.below(256), b = random.below(256);
    const Hsv expected = hsv_of(r, g, b);
    if (expected.chroma < 60) continue;
    const std::uint8_t rgb[6] = {static_cast<std::uint8_t>(r),
                                 static_cast<std::uint8_t>(g),
                                 static_cast<std::uint8_t>(b),
                                 0,
                                 0,
                                 0};
    hal::ImageView view;
    view.width = 2;
    view.height = 1;
    view.format = hal::PixelFormat::kRgb24;
    view.range = hal::ColourRange::kFull;
    view.plane[0] = rgb;
    view.stride[0] = 6;
    std::uint8_t y[3], u[3], v[3];
    unpack_row(view, 0, y, u, v);
    const std::uint16_t cell = hue_value_table().cell(y[0], u[0], v[0]);
    EXPECT_LE(hue_distance(cell & 0xFF, static_cast<int>(std::lround(expected.hue)) & 255), 3);
    EXPECT_NEAR(cell >> 8, expected.value, 3);
  }
}

TEST(HueValue, grey_has_hue_zero) { EXPECT_EQ(hue_value_table().hue(128, 128), 0); }

TEST(HueDistance, is_circular_and_at_most_half_the_circle) {
  EXPECT_EQ(hue_distance(254, 2), 4);
  EXPECT_EQ(hue_distance(0, 128), 128);
  EXPECT_EQ(hue_distance(128, 0), 128);
  for (int a = 0; a < 256; ++a) {
    for (int b = 0; b < 256; b += 7) {
      EXPECT_EQ(hue_distance(a, b), hue_distance(b, a));
      EXPECT_LE(hue_distance(a, b), 128);
    }
  }
}

TEST(MeanHue, does_not_break_at_red) {
  // Two reds either side of 0: the mean is red, not the cyan that a plain mean gives.
  const Yuv a = {80, 90, 220};
  const Yuv b = {80, 110, 220};
  const int mean = mean_hue(std::array{a, b});
  const int hue_a = hue_value_of(a) & 0xFF;
  const int hue_b = hue_value_of(b) & 0xFF;
  EXPECT_LE(hue_distance(mean, hue_a), hue_distance(hue_a, hue_b));
  EXPECT_LE(hue_distance(mean, hue_b), hue_distance(hue_a, hue_b));
}

TEST(MeanHue, counts_grey_for_nothing) {
  const Yuv red = {80, 100, 200};
  const Yuv grey = {90, 128, 128};
  EXPECT_EQ(mean_hue(std::array{red, grey, grey, grey}), mean_hue(std::array{red}));
  EXPECT_EQ(mean_hue(std::array{grey}), 0);
}

}  // namespace
}  // namespace gannet::vision
