#include "hal/camera/camera_kinds.hpp"

#include <gtest/gtest.h>

namespace gannet::hal {
namespace {

TEST(CameraKinds, an_unknown_kind_is_refused_with_the_known_ones) {
  CameraConfig config;
  config.kind = "webcam";
  const auto sut = make_stereo_camera(config, nullptr, Pace::kLive);
  ASSERT_FALSE(sut);
  EXPECT_EQ(sut.error().text, "camera.kind: 'webcam' is not known; known are replay, simulated");
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

}  // namespace
}  // namespace gannet::hal
