#include "hal/camera/pixel_access.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "hal/camera/image.hpp"
#include "platform/base/random.hpp"

namespace gannet::hal {
namespace {

constexpr ColourMatrix kMatrices[] = {ColourMatrix::kBt601, ColourMatrix::kBt709};
constexpr ColourRange kRanges[] = {ColourRange::kLimited, ColourRange::kFull};

TEST(PixelAccess, reads_each_format_where_it_stores_the_pixel) {
  // Two rows of four pixels: luma 10 + 10·index, chroma of cell c: U 100 + c, V 200 + c.
  Image yuyv(4, 2, PixelFormat::kYuyv), uyvy(4, 2, PixelFormat::kUyvy);
  const std::uint8_t yuyv_bytes[] = {10, 100, 20, 200, 30, 101, 40, 201,
                                     50, 102, 60, 202, 70, 103, 80, 203};
  std::copy(std::begin(yuyv_bytes), std::end(yuyv_bytes), yuyv.plane(0));
  for (int i = 0; i < 16; i += 2)
    uyvy.plane(0)[i] = yuyv_bytes[i + 1], uyvy.plane(0)[i + 1] = yuyv_bytes[i];
  using Stored = std::array<std::uint8_t, 3>;
  for (const Image* image : {&yuyv, &uyvy}) {
    EXPECT_EQ(stored_at(image->view(), 0, 0), (Stored{10, 100, 200}));
    EXPECT_EQ(stored_at(image->view(), 3, 0), (Stored{40, 101, 201}));
    EXPECT_EQ(stored_at(image->view(), 2, 1), (Stored{70, 103, 203}));
    EXPECT_EQ(stored_at(image->view(), 1, 1), (Stored{60, 102, 202}));
  }
  Image nv12(4, 2, PixelFormat::kNv12);
  for (int i = 0; i < 8; ++i) nv12.plane(0)[i] = static_cast<std::uint8_t>(10 * (i + 1));
  const std::uint8_t chroma[] = {100, 200, 101, 201};
  std::copy(std::begin(chroma), std::end(chroma), nv12.plane(1));
  EXPECT_EQ(stored_at(nv12.view(), 3, 1), (Stored{80, 101, 201}));
  EXPECT_EQ(stored_at(nv12.view(), 0, 1), (Stored{50, 100, 200}));
}

TEST(PixelAccess, known_colours_have_their_published_codes) {
  // BT.601 limited: red 81 90 240, green 145 54 34, blue 41 240 110 (colour bars at 100 %).
  const ColourMap bars = yuv_from_rgb(ColourMatrix::kBt601, ColourRange::kLimited);
  EXPECT_EQ(to_yuv(bars, 255, 0, 0), (YuvPixel{81, 90, 240}));
  EXPECT_EQ(to_yuv(bars, 0, 255, 0), (YuvPixel{145, 54, 34}));
  EXPECT_EQ(to_yuv(bars, 0, 0, 255), (YuvPixel{41, 240, 110}));
  // BT.709 limited: red 63 102 240, green 173 42 26, blue 32 240 118.
  const ColourMap hd = yuv_from_rgb(ColourMatrix::kBt709, ColourRange::kLimited);
  EXPECT_EQ(to_yuv(hd, 255, 0, 0), (YuvPixel{63, 102, 240}));
  EXPECT_EQ(to_yuv(hd, 0, 255, 0), (YuvPixel{173, 42, 26}));
  EXPECT_EQ(to_yuv(hd, 0, 0, 255), (YuvPixel{32, 240, 118}));
  // JFIF: red 76 85 255.
  const ColourMap jfif = yuv_from_rgb(ColourMatrix::kBt601, ColourRange::kFull);
  EXPECT_EQ(to_yuv(jfif, 255, 0, 0), (YuvPixel{76, 85, 255}));
  for (const ColourMap& map : {bars, hd}) {
    EXPECT_EQ(to_yuv(map, 0, 0, 0), (YuvPixel{16, 128, 128}));
    EXPECT_EQ(to_yuv(map, 255, 255, 255), (YuvPixel{235, 128, 128}));
  }
}

TEST(PixelAccess, rgb_to_yuv_and_back_is_the_identity_for_each_matrix_and_range) {
  Random random(7);
  for (ColourMatrix matrix : kMatrices)
    for (ColourRange range : kRanges) {
      const ColourMap sut = chain(rgb_from_yuv(matrix, range), yuv_from_rgb(matrix, range));
      for (int i = 0; i < 100; ++i) {
        const double r = random.below(256), g = random.below(256), b = random.below(256);
        const auto [r2, g2, b2] = sut(r, g, b);
        EXPECT_NEAR(r2, r, 1e-9);
        EXPECT_NEAR(g2, g, 1e-9);
        EXPECT_NEAR(b2, b, 1e-9);
      }
    }
}

TEST(PixelAccess, the_same_colour_reads_alike_in_every_matrix_and_range) {
  Random random(9);
  for (int i = 0; i < 200; ++i) {
    const double r = random.below(256), g = random.below(256), b = random.below(256);
    const YuvPixel truth = to_yuv(yuv_from_rgb(ColourMatrix::kBt601, ColourRange::kFull), r, g, b);
    for (ColourMatrix matrix : kMatrices)
      for (ColourRange range : kRanges) {
        Image image(1, 1, PixelFormat::kYuv444, matrix, range);
        const YuvPixel stored = to_yuv(yuv_from_rgb(matrix, range), r, g, b);
        *image.plane(0) = stored.y, *image.plane(1) = stored.u, *image.plane(2) = stored.v;
        const YuvPixel sut = yuv_at(image.view(), 0, 0);
        EXPECT_LE(std::abs(sut.y - truth.y), 2);  // rounding of the stored codes
        EXPECT_LE(std::abs(sut.u - truth.u), 2);
        EXPECT_LE(std::abs(sut.v - truth.v), 2);
      }
  }
}

TEST(PixelAccess, full_range_bt601_is_read_unchanged) {
  const ColourMap sut =
      full_bt601_from(PixelFormat::kYuv444, ColourMatrix::kBt601, ColourRange::kFull);
  for (int y = 0; y < 256; y += 5)
    for (int u = 0; u < 256; u += 15)
      for (int v = 0; v < 256; v += 15) {
        const YuvPixel expected{static_cast<std::uint8_t>(y), static_cast<std::uint8_t>(u),
                                static_cast<std::uint8_t>(v)};
        EXPECT_EQ(to_yuv(sut, y, u, v), expected);
      }
}

TEST(PixelAccess, rgb24_is_read_as_rgb_and_as_yuv) {
  Image image(2, 1, PixelFormat::kRgb24);
  const std::uint8_t bytes[] = {255, 0, 0, 1, 2, 3};
  std::copy(std::begin(bytes), std::end(bytes), image.plane(0));
  EXPECT_EQ(yuv_at(image.view(), 0, 0), (YuvPixel{76, 85, 255}));
  EXPECT_EQ(rgb_at(image.view(), 1, 0), (RgbPixel{1, 2, 3}));
}

}  // namespace
}  // namespace gannet::hal
