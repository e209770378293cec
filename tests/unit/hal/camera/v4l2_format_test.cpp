#include "hal/camera/v4l2_format.hpp"

#include <gtest/gtest.h>

#include "hal/camera/image.hpp"
#include "hal/camera/pixel_access.hpp"
#include "hal/camera/v4l2_offer.hpp"
#include "tests/support/scripted_v4l2.hpp"

namespace gannet::hal {
namespace {

class V4l2FormatTest : public ::testing::Test {
 protected:
  Result<V4l2Format> negotiated() {
    const int fd = system_.open("cam");
    auto format = negotiate(system_, fd, "cam", config_);
    system_.close(fd);
    return format;
  }
  std::string refusal() {
    const auto format = negotiated();
    return format ? "accepted" : format.error().text;
  }
  test::ScriptedV4l2 system_;
  test::ScriptedV4l2::Device& device_ = system_.add("cam");
  V4l2StreamConfig config_ = {.width = 16, .height = 4, .rate_hz = 25};
};

TEST_F(V4l2FormatTest, what_fits_is_taken_with_its_rows_and_colours) {
  device_.padding = 6;
  const auto sut = negotiated();
  ASSERT_TRUE(sut) << sut.error().text;
  EXPECT_EQ(sut->stride, 38);
  EXPECT_EQ(sut->bytes, 3u * 38 + 32);
  EXPECT_EQ(sut->rate_hz, 25);
  EXPECT_EQ(sut->matrix, ColourMatrix::kBt601);
  EXPECT_EQ(sut->range, ColourRange::kLimited);
}

TEST_F(V4l2FormatTest, colour_spaces_say_matrix_and_range) {
  device_.colourspace = V4L2_COLORSPACE_REC709;
  EXPECT_EQ(negotiated()->matrix, ColourMatrix::kBt709);
  device_.colourspace = V4L2_COLORSPACE_JPEG;
  EXPECT_EQ(negotiated()->range, ColourRange::kFull);
}

TEST_F(V4l2FormatTest, a_size_that_is_not_there_is_refused_with_what_is_offered) {
  device_.modes = {{.width = 640, .height = 480, .rates_hz = {30, 15}},
                   {.width = 320, .height = 180, .rates_hz = {60}},
                   {.fourcc = V4L2_PIX_FMT_MJPEG, .width = 1280, .height = 720, .rates_hz = {30}},
                   {.fourcc = V4L2_PIX_FMT_RGB24, .width = 640, .height = 480, .rates_hz = {30}}};
  config_ = {.width = 320, .height = 240, .rate_hz = 30};
  EXPECT_EQ(refusal(),
            "cam: does not give yuyv 320 × 240 at 30 Hz (it makes 320 × 180 of it); it offers\n"
            "  yuyv 640 × 480 at 30, 15 Hz\n"
            "  yuyv 320 × 180 at 60 Hz\n"
            "  mjpeg 1280 × 720 at 30 Hz\n"
            "  RGB3 (not usable) 640 × 480 at 30 Hz");
}

TEST_F(V4l2FormatTest, a_format_or_rate_that_is_not_there_is_refused) {
  config_.format = "nv12";
  EXPECT_NE(refusal().find("(it takes another format); it offers\n  yuyv 16 × 4 at 50, 25 Hz"),
            std::string::npos);
  config_.format = "yuyv";
  config_.rate_hz = 40;
  EXPECT_NE(refusal().find("does not give yuyv 16 × 4 at 40 Hz (it keeps 50 Hz)"),
            std::string::npos);
  config_.rate_hz = 0;
  EXPECT_EQ(negotiated()->rate_hz, 50);
}

TEST_F(V4l2FormatTest, a_fixed_rate_is_taken_if_it_is_the_wanted_one) {
  device_.rate_can_be_set = false;
  EXPECT_NE(refusal().find("it keeps 50 Hz"), std::string::npos);
  config_.rate_hz = 50;
  EXPECT_TRUE(negotiated());
}

TEST_F(V4l2FormatTest, a_rate_is_asked_of_a_driver_that_does_not_say_it_can) {
  device_.loops_back = true;
  EXPECT_EQ(negotiated()->rate_hz, 25);
}

TEST_F(V4l2FormatTest, a_device_without_any_format_says_so) {
  device_.modes.clear();
  EXPECT_EQ(refusal(), "cam: does not give yuyv 16 × 4 at 25 Hz (Invalid argument)");
}

TEST_F(V4l2FormatTest, nv12_has_its_chroma_behind_the_padded_luma) {
  device_.modes = {{.fourcc = V4L2_PIX_FMT_NV12}};
  device_.padding = 16;
  config_.format = "nv12";
  config_.rate_hz = 0;
  const auto sut = negotiated();
  ASSERT_TRUE(sut);
  EXPECT_EQ(sut->bytes, 5u * 32 + 16);
  const std::vector<std::uint8_t> bytes(6 * 32);
  const ImageView view = view_of(*sut, bytes.data());
  EXPECT_EQ(view.plane[1], bytes.data() + 4 * 32);
  EXPECT_TRUE(is_complete(view));
}

TEST(ColumnsOf, are_the_same_pixels_in_every_format) {
  for (const PixelFormat format :
       {PixelFormat::kYuyv, PixelFormat::kUyvy, PixelFormat::kNv12, PixelFormat::kYuv422,
        PixelFormat::kYuv420, PixelFormat::kYuv444, PixelFormat::kRgb24}) {
    Image image(16, 4, format);
    std::uint8_t next = 0;
    for (std::uint8_t& byte : image.bytes()) byte = next += 37;
    const ImageView whole = image.view(), sut = columns_of(whole, 6, 8);
    ASSERT_EQ(sut.width, 8);
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 8; ++x)
        EXPECT_EQ(stored_at(sut, x, y), stored_at(whole, x + 6, y)) << to_string(format);
  }
}

}  // namespace
}  // namespace gannet::hal
