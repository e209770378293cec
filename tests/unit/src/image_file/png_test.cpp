#include "src/image_file/png.hpp"

#include <gtest/gtest.h>

#include "hal/camera/pixel_access.hpp"
#include "platform/base/random.hpp"

namespace gannet::image_file {
namespace {

template <class Sample>
Raster<Sample> noise(int width, int height, int channels) {
  Raster<Sample> raster(width, height, channels);
  Random random(3);
  for (Sample& sample : raster.samples) sample = static_cast<Sample>(random.next() >> 20);
  return raster;
}

TEST(Png, eight_bit_rasters_come_back_unchanged) {
  for (int channels : {1, 3, 4}) {
    const Raster8 raster = noise<std::uint8_t>(31, 17, channels);
    const auto bytes = encode_png(raster);
    ASSERT_TRUE(bytes);
    const auto sut = decode_png8(*bytes, channels);
    ASSERT_TRUE(sut) << sut.error().text;
    EXPECT_EQ(sut->width, 31);
    EXPECT_EQ(sut->height, 17);
    EXPECT_EQ(sut->samples, raster.samples);
  }
}

TEST(Png, sixteen_bit_grey_comes_back_unchanged_and_loses_only_its_lower_byte_as_rgb) {
  const Raster16 raster = noise<std::uint16_t>(9, 12, 1);
  const auto bytes = encode_png(raster);
  ASSERT_TRUE(bytes);
  EXPECT_EQ(decode_png16(*bytes)->samples, raster.samples);
  const auto sut = decode_png(*bytes);
  ASSERT_TRUE(sut);
  for (int i = 0; i < 9 * 12; ++i)
    EXPECT_NEAR(sut->plane(0)[3 * i], raster.samples[static_cast<std::size_t>(i)] / 257.0, 0.51);
}

TEST(Png, alpha_is_dropped_from_pictures_and_opaque_where_there_is_none) {
  const Raster8 raster = noise<std::uint8_t>(8, 8, 4);
  const auto picture = decode_png(*encode_png(raster));
  ASSERT_TRUE(picture);
  const Raster8 rgb = noise<std::uint8_t>(8, 8, 3);
  const auto opaque = decode_png8(*encode_png(rgb), 4);
  ASSERT_TRUE(opaque);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(picture->row(0, y)[3 * x + c], raster.at(x, y)[c]);
        EXPECT_EQ(opaque->at(x, y)[c], rgb.at(x, y)[c]);
      }
      EXPECT_EQ(opaque->at(x, y)[3], 255);
    }
}

TEST(Png, an_image_of_any_format_is_written_as_rgb) {
  hal::Image image(6, 4, hal::PixelFormat::kYuyv, hal::ColourMatrix::kBt709,
                   hal::ColourRange::kLimited);
  Random random(4);
  for (auto& byte : image.bytes()) byte = static_cast<std::uint8_t>(random.below(256));
  const auto sut = decode_png(*encode_png(image.view()));
  ASSERT_TRUE(sut);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 6; ++x)
      EXPECT_EQ(hal::rgb_at(sut->view(), x, y), hal::rgb_at(image.view(), x, y));
}

TEST(Png, every_truncation_is_an_error_that_names_the_byte_and_prints_nothing) {
  const auto bytes = encode_png(noise<std::uint8_t>(20, 20, 3));
  ASSERT_TRUE(bytes);
  ::testing::internal::CaptureStderr();
  for (std::size_t size = 0; size < bytes->size(); size += 7) {
    const auto sut = decode_png(std::span(*bytes).first(size));
    ASSERT_FALSE(sut) << size;
    if (size < 8)
      EXPECT_EQ(sut.error().text, "not a PNG");
    else
      EXPECT_NE(sut.error().text.find("of " + std::to_string(size)), std::string::npos)
          << sut.error().text;
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Png, a_flipped_bit_in_the_pixels_is_found_by_the_checksum) {
  auto bytes = *encode_png(noise<std::uint8_t>(20, 20, 3));
  bytes[bytes.size() / 2] ^= 0x10;
  const auto sut = decode_png(bytes);
  ASSERT_FALSE(sut);
  EXPECT_NE(sut.error().text.find("broken PNG at byte"), std::string::npos) << sut.error().text;
}

// PNG's checksum (ISO 15948, annex D).
std::uint32_t checksum(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = ~0u;
  for (std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

void put_u32(std::uint8_t* at, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) at[i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

TEST(Png, a_header_that_promises_a_huge_image_is_refused_before_memory_is_taken) {
  auto bytes = *encode_png(noise<std::uint8_t>(20, 20, 3));
  const auto with_size = [&](std::uint32_t width, std::uint32_t height) {
    put_u32(&bytes[16], width);
    put_u32(&bytes[20], height);
    put_u32(&bytes[29], checksum(std::span(bytes).subspan(12, 17)));
    return decode_png(bytes);
  };
  EXPECT_TRUE(with_size(20, 20));
  EXPECT_NE(with_size(16384, 16384).error().text.find("more than are accepted"), std::string::npos);
  EXPECT_NE(with_size(16385, 1).error().text.find("broken PNG at byte"), std::string::npos);
}

TEST(Png, a_claimed_gamma_changes_no_value) {
  Raster8 raster(1, 1, 3);
  raster.samples = {200, 100, 50};
  auto bytes = *encode_png(raster);
  std::vector<std::uint8_t> gamma(16);  // gAMA of 1/2.2, between header and pixels
  put_u32(&gamma[0], 4);
  std::copy_n("gAMA", 4, &gamma[4]);
  put_u32(&gamma[8], 45455);
  put_u32(&gamma[12], checksum(std::span(gamma).subspan(4, 8)));
  bytes.insert(bytes.begin() + 33, gamma.begin(), gamma.end());
  EXPECT_EQ(decode_png8(bytes, 3)->samples, raster.samples);
  EXPECT_EQ(decode_png8(bytes, 1)->samples, (std::vector<std::uint8_t>{124}));
  EXPECT_EQ(decode_png16(bytes)->samples, (std::vector<std::uint16_t>{31919}));
}

TEST(Png, rasters_that_do_not_fit_are_not_written) {
  Raster8 sut = noise<std::uint8_t>(4, 4, 3);
  sut.samples.pop_back();
  EXPECT_FALSE(encode_png(sut));
  EXPECT_FALSE(encode_png(Raster8(0, 4, 3)));
  EXPECT_FALSE(encode_png(Raster8(4, 4, 2)));
}

}  // namespace
}  // namespace gannet::image_file
