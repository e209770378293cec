#include "src/image_file/jpeg.hpp"

#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <cmath>

#include "hal/camera/pixel_access.hpp"

namespace gannet::image_file {
namespace {

// Smooth colours, so that compression changes them little.
hal::Image gradient(int width, int height) {
  hal::Image image(width, height, hal::PixelFormat::kRgb24);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      std::uint8_t* pixel = image.row(0, y) + 3 * x;
      pixel[0] = static_cast<std::uint8_t>(40 + 160 * x / width);
      pixel[1] = static_cast<std::uint8_t>(60 + 120 * y / height);
      pixel[2] = static_cast<std::uint8_t>(200 - 100 * x / width);
    }
  return image;
}

// By the library itself, in ways that encode_jpeg does not offer.
std::vector<std::uint8_t> compress(const hal::Image& rgb, int subsampling, int flags = 0) {
  tjhandle handle = tjInitCompress();
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  tjCompress2(handle, rgb.plane(0), rgb.width(), rgb.stride(0), rgb.height(), TJPF_RGB, &bytes,
              &size, subsampling, 98, flags);
  std::vector<std::uint8_t> out(bytes, bytes + size);
  tjFree(bytes);
  tjDestroy(handle);
  return out;
}

double worst_difference(const hal::ImageView& a, const hal::ImageView& b) {
  int worst = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const auto p = hal::yuv_at(a, x, y), q = hal::yuv_at(b, x, y);
      worst = std::max({worst, std::abs(p.y - q.y), std::abs(p.u - q.u), std::abs(p.v - q.v)});
    }
  return worst;
}

TEST(Jpeg, each_subsampling_becomes_its_planar_format_with_the_right_colours) {
  struct Case {
    int subsampling;
    hal::PixelFormat format;
  };
  const hal::Image image = gradient(64, 48);
  for (const Case& c :
       {Case{TJSAMP_420, hal::PixelFormat::kYuv420}, Case{TJSAMP_422, hal::PixelFormat::kYuv422},
        Case{TJSAMP_444, hal::PixelFormat::kYuv444}, Case{TJSAMP_440, hal::PixelFormat::kYuv444},
        Case{TJSAMP_411, hal::PixelFormat::kYuv444}}) {
    const auto sut = decode_jpeg(compress(image, c.subsampling));
    ASSERT_TRUE(sut) << sut.error().text;
    EXPECT_EQ(sut->format(), c.format);
    EXPECT_LE(worst_difference(sut->view(), image.view()), 7) << c.subsampling;
  }
}

TEST(Jpeg, grey_has_neutral_chroma) {
  const hal::Image image = gradient(40, 30);
  const auto sut = decode_jpeg(compress(image, TJSAMP_GRAY));
  ASSERT_TRUE(sut) << sut.error().text;
  for (int x = 0; x < 40; ++x) {
    const auto pixel = hal::yuv_at(sut->view(), x, 15);
    EXPECT_NEAR(pixel.y, hal::yuv_at(image.view(), x, 15).y, 3);
    EXPECT_EQ(pixel.u, 128);
    EXPECT_EQ(pixel.v, 128);
  }
}

TEST(Jpeg, odd_sides_keep_their_last_row_and_column) {
  const hal::Image image = gradient(33, 21);
  for (int subsampling :
       {TJSAMP_420, TJSAMP_422, TJSAMP_444, TJSAMP_440, TJSAMP_411, TJSAMP_GRAY}) {
    const auto sut = decode_jpeg(compress(image, subsampling));
    ASSERT_TRUE(sut) << sut.error().text;
    EXPECT_EQ(sut->width(), 33);
    EXPECT_EQ(sut->height(), 21);
    EXPECT_NEAR(hal::yuv_at(sut->view(), 32, 20).y, hal::yuv_at(image.view(), 32, 20).y, 4);
  }
}

TEST(Jpeg, what_is_encoded_from_planes_decodes_to_nearly_the_same_planes) {
  const auto yuv420 = decode_jpeg(compress(gradient(64, 48), TJSAMP_420));
  ASSERT_TRUE(yuv420);
  const auto again = decode_jpeg(*encode_jpeg(yuv420->view(), 98));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->format(), hal::PixelFormat::kYuv420);
  EXPECT_LE(worst_difference(again->view(), yuv420->view()), 2);
  const hal::Image rgb = gradient(33, 21);
  const auto odd = decode_jpeg(*encode_jpeg(rgb.view(), 98));
  ASSERT_TRUE(odd);
  EXPECT_LE(worst_difference(odd->view(), rgb.view()), 4);
}

TEST(Jpeg, every_truncation_is_an_error_and_prints_nothing) {
  for (int flags : {0, TJFLAG_PROGRESSIVE}) {
    const auto bytes = compress(gradient(64, 48), TJSAMP_420, flags);
    ::testing::internal::CaptureStderr();
    for (std::size_t size = 0; size < bytes.size(); size += 5) {
      const auto sut = decode_jpeg(std::span(bytes).first(size));
      ASSERT_FALSE(sut) << size << " of " << bytes.size();
      EXPECT_FALSE(sut.error().text.empty());
    }
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  }
}

TEST(Jpeg, padding_before_the_end_marker_is_accepted_as_cameras_send_it) {
  auto bytes = compress(gradient(64, 48), TJSAMP_422);
  bytes.insert(bytes.end() - 2, 32, std::uint8_t{0});
  EXPECT_TRUE(decode_jpeg(bytes));
}

TEST(Jpeg, four_colours_are_refused_with_advice) {
  tjhandle handle = tjInitCompress();
  const std::vector<std::uint8_t> pixels(16 * 16 * 4, 90);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  ASSERT_EQ(
      tjCompress2(handle, pixels.data(), 16, 0, 16, TJPF_CMYK, &bytes, &size, TJSAMP_444, 90, 0),
      0);
  const auto sut = decode_jpeg(std::span(bytes, size));
  ASSERT_FALSE(sut);
  EXPECT_NE(sut.error().text.find("CMYK"), std::string::npos);
  tjFree(bytes);
  tjDestroy(handle);
}

}  // namespace
}  // namespace gannet::image_file
