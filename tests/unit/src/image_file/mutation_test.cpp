// The fuzz targets of this room on a few hundred mutated files: a target traps if it is wrong.
#include <gtest/gtest.h>

#include "tests/fuzz/mutate.hpp"

#define LLVMFuzzerTestOneInput fuzz_png
#include "tests/fuzz/png_fuzz.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_jpeg
#include "tests/fuzz/jpeg_fuzz.cpp"
#undef LLVMFuzzerTestOneInput

namespace gannet::image_file {
namespace {

hal::Image picture(hal::PixelFormat format) {
  hal::Image image(48, 32, format);
  Random random(6);
  for (std::size_t i = 0; i < image.bytes().size(); ++i)
    image.bytes()[i] = static_cast<std::uint8_t>(i / 7 + static_cast<std::size_t>(random.below(9)));
  return image;
}

TEST(Mutation, no_png_however_broken_does_harm) {
  Raster16 deep(10, 10, 1);
  for (std::size_t i = 0; i < deep.samples.size(); ++i)
    deep.samples[i] = static_cast<std::uint16_t>(601 * i);
  ::testing::internal::CaptureStderr();
  run_mutations({*encode_png(picture(hal::PixelFormat::kRgb24).view()), *encode_png(deep),
                 *encode_png(Raster8(10, 10, 4))},
                2000, fuzz_png);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Mutation, no_jpeg_however_broken_does_harm) {
  ::testing::internal::CaptureStderr();
  run_mutations({*encode_jpeg(picture(hal::PixelFormat::kYuv420).view(), 80),
                 *encode_jpeg(picture(hal::PixelFormat::kYuv444).view(), 95)},
                400, fuzz_jpeg);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace gannet::image_file
