#include "hal/camera/camera_kinds.hpp"

#include <gtest/gtest.h>

namespace gannet::hal {
namespace {

TEST(CameraKinds, an_unknown_kind_is_refused_with_the_known_ones) {
  CameraConfig config;
  config.kind = "webcam";
  const auto sut = make_stereo_camera(config, nullptr, Pace::kLive);
  ASSERT_FALSE(sut);
  EXPECT_EQ(sut.error().text,
            "camera.kind: 'webcam' is not known; known are replay, simulated, v4l2_pair, "
            "v4l2_side_by_side");
}

TEST(CameraKinds, the_kind_that_is_asked_for_is_made) {
  CameraConfig config;
  EXPECT_TRUE(make_stereo_camera(config, nullptr, Pace::kStepped));
  config.kind = "replay";
  config.replay.directory = "/nonexistent";
  const auto sut = make_stereo_camera(config, nullptr, Pace::kStepped);
  ASSERT_FALSE(sut);
  EXPECT_NE(sut.error().text.find("/nonexistent/left: cannot list"), std::string::npos);
}

TEST(CameraKinds, v4l2_kinds_say_what_their_config_lacks) {
  const auto refusal = [](const CameraConfig& config, Pace pace) {
    const auto made = make_stereo_camera(config, nullptr, pace);
    return made ? "made" : made.error().text;
  };
  CameraConfig config;
  config.kind = "v4l2_pair";
  auto& pair = config.v4l2_pair;
  EXPECT_NE(refusal(config, Pace::kLive).find("must name devices"), std::string::npos);
  pair.left = pair.right = "a";
  EXPECT_NE(refusal(config, Pace::kLive).find("the same device"), std::string::npos);
  pair.right = "b";
  EXPECT_EQ(refusal(config, Pace::kLive), "made");
  EXPECT_NE(refusal(config, Pace::kStepped).find("live clock"), std::string::npos);
  pair.pair_tolerance_s = 0.5 / pair.stream.rate_hz;
  EXPECT_NE(refusal(config, Pace::kLive).find("half a period"), std::string::npos);
  pair.pair_tolerance_s = 0.001;
  pair.stream.format = "mjpeg";
  EXPECT_NE(refusal(config, Pace::kLive).find("mjpeg cannot be decoded"), std::string::npos);

  config.kind = "v4l2_side_by_side";
  EXPECT_NE(refusal(config, Pace::kLive).find("device must be named"), std::string::npos);
  config.v4l2_side_by_side.device = "a";
  EXPECT_EQ(refusal(config, Pace::kLive), "made");
  config.v4l2_side_by_side.stream.width = 1282;
  EXPECT_NE(refusal(config, Pace::kLive).find("multiple of 4"), std::string::npos);
}

}  // namespace
}  // namespace gannet::hal
