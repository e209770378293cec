#include "hal/camera/image.hpp"

#include <gtest/gtest.h>

#include "platform/base/random.hpp"

namespace gannet::hal {
namespace {

constexpr PixelFormat kFormats[] = {
    PixelFormat::kYuyv,   PixelFormat::kUyvy,   PixelFormat::kNv12, PixelFormat::kYuv422,
    PixelFormat::kYuv420, PixelFormat::kYuv444, PixelFormat::kRgb24};

Image noise(int width, int height, PixelFormat format) {
  Image image(width, height, format);
  Random random(5);
  for (std::uint8_t& byte : image.bytes()) byte = static_cast<std::uint8_t>(random.below(256));
  return image;
}

TEST(Image, planes_of_each_format_fill_the_block_without_overlap) {
  for (PixelFormat format : kFormats) {
    const ImageLayout sut = layout_of(format, 38, 22);
    ASSERT_GE(sut.planes, 1) << to_string(format);
    std::size_t end = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(sut.planes); ++i) {
      EXPECT_GE(sut.offset[i], end);
      EXPECT_EQ(sut.offset[i] % 64, 0u);
      end = sut.offset[i] + static_cast<std::size_t>(sut.stride[i] * sut.rows[i]);
    }
    EXPECT_LE(end, sut.bytes);
  }
}

TEST(Image, sizes_that_a_format_cannot_have_give_no_layout) {
  for (PixelFormat format : kFormats) {
    EXPECT_EQ(layout_of(format, 0, 2).bytes, 0u);
    EXPECT_EQ(layout_of(format, 2, -2).bytes, 0u);
    EXPECT_EQ(layout_of(format, kMaxImageSide + 2, 2).bytes, 0u);
    EXPECT_GT(layout_of(format, kMaxImageSide, kMaxImageSide).bytes, 0u);
  }
  EXPECT_EQ(layout_of(PixelFormat::kYuyv, 3, 2).bytes, 0u);
  EXPECT_EQ(layout_of(PixelFormat::kYuv420, 4, 3).bytes, 0u);
  EXPECT_GT(layout_of(PixelFormat::kYuv422, 4, 3).bytes, 0u);
  EXPECT_GT(layout_of(PixelFormat::kRgb24, 3, 3).bytes, 0u);
}

TEST(Image, a_copy_of_a_view_with_wide_strides_has_the_same_pixels) {
  for (PixelFormat format : kFormats) {
    const Image wide = noise(40, 20, format);
    ImageView part = wide.view();  // the upper left quarter of it
    part.width = 20;
    part.height = 10;
    const Image sut = copy_of(part);
    ASSERT_TRUE(is_complete(part) && is_complete(sut.view()));
    const Image expected = to_rgb24(part), actual = to_rgb24(sut.view());
    EXPECT_TRUE(std::equal(expected.bytes().begin(), expected.bytes().end(), actual.bytes().begin(),
                           actual.bytes().end()))
        << to_string(format);
  }
}

TEST(Image, a_view_without_a_plane_or_with_short_rows_is_not_complete) {
  const Image image = noise(16, 16, PixelFormat::kNv12);
  ImageView sut = image.view();
  EXPECT_TRUE(is_complete(sut));
  sut.plane[1] = nullptr;
  EXPECT_FALSE(is_complete(sut));
  sut = image.view();
  sut.stride[0] = 15;
  EXPECT_FALSE(is_complete(sut));
  EXPECT_FALSE(is_complete(ImageView{}));
}

TEST(Image, yuv444_of_full_range_bt601_is_a_plain_repetition) {
  const Image image = noise(8, 4, PixelFormat::kYuv420);
  const Image sut = to_yuv444(image.view());
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) {
      EXPECT_EQ(sut.row(0, y)[x], image.row(0, y)[x]);
      EXPECT_EQ(sut.row(1, y)[x], image.row(1, y / 2)[x / 2]);
      EXPECT_EQ(sut.row(2, y)[x], image.row(2, y / 2)[x / 2]);
    }
}

}  // namespace
}  // namespace gannet::hal
