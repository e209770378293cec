#include "src/vision/prepared_frame.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "platform/base/random.hpp"

namespace gannet::vision {
namespace {

using hal::PixelFormat;

constexpr int kWidth = 120, kHeight = 74;

// Planes with room for every format, and strides of their own.
struct Noise {
  std::vector<std::uint8_t> bytes = std::vector<std::uint8_t>(3 * 4 * kWidth * kHeight);
  hal::ImageView view;
  Noise(PixelFormat format, std::uint64_t seed) {
    Random random(seed);
    for (auto& b : bytes) b = static_cast<std::uint8_t>(random.below(256));
    view.width = kWidth;
    view.height = kHeight;
    view.format = format;
    for (std::size_t p = 0; p < 3; ++p) {
      view.plane[p] = bytes.data() + 4 * p * kWidth * kHeight;
      view.stride[p] = 3 * kWidth + 5;
    }
  }
};

class Prepared : public testing::TestWithParam<PixelFormat> {};

TEST_P(Prepared, has_the_same_bytes_in_two_steps_as_in_one) {
  const Noise left(GetParam(), 1), right(GetParam(), 2);
  PreparedFrame whole(kWidth, kHeight, {.packed = true}), parts(kWidth, kHeight, {.packed = true});
  ASSERT_TRUE(whole.prepare(left.view, right.view));
  ASSERT_TRUE(parts.prepare_coarse(left.view, right.view, 1));
  for (const Region region : {Region{33, 10, 71, 40},
                              {-9, -4, 20, 30},
                              {90, 50, 500, 500},
                              {0, 0, kWidth, kHeight},
                              {60, 30, 61, 31}}) {
    parts.prepare_fine(left.view, right.view, region, region);
    for (int row = std::max(region.top, 0); row < std::min(region.bottom, kHeight); ++row) {
      for (int x = std::max(region.left, 0); x < std::min(region.right, kWidth); ++x) {
        const int at = row * kWidth + x;
        ASSERT_EQ(parts.left().packed[0].cells[at], whole.left().packed[0].cells[at]) << x;
        ASSERT_EQ(parts.right().smooth[1][at], whole.right().smooth[1][at]) << x;
      }
    }
  }
  for (std::size_t l = 1; l < kLevels; ++l) {
    const PackedPlane& a = whole.left().packed[l];
    EXPECT_TRUE(std::equal(a.cells, a.cells + a.guard, parts.left().packed[l].cells)) << l;
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, Prepared,
                         testing::Values(PixelFormat::kYuyv, PixelFormat::kUyvy, PixelFormat::kNv12,
                                         PixelFormat::kYuv422, PixelFormat::kYuv420,
                                         PixelFormat::kYuv444, PixelFormat::kRgb24));

TEST(PreparedFrame, refuses_other_sizes) {
  const Noise image(PixelFormat::kYuyv, 1);
  PreparedFrame sut(kWidth, kHeight + 2, {.packed = true});
  EXPECT_FALSE(sut.prepare(image.view, image.view));
  EXPECT_FALSE(sut.prepare_coarse(image.view, image.view, 2));
}

}  // namespace
}  // namespace gannet::vision
