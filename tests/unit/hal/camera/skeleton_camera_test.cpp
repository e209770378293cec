#include "hal/camera/skeleton_camera.hpp"

#include <gtest/gtest.h>

#include "platform/linux/clock.hpp"

namespace gannet::hal {
namespace {

using std::chrono::milliseconds;

std::unique_ptr<StereoCamera> make(const SkeletonCameraConfig& config, Pace pace) {
  auto camera = SkeletonCamera::create(config, pace);
  EXPECT_TRUE(camera && (*camera)->start());
  return std::move(*camera);
}

TEST(SkeletonCamera, stepped_gives_what_is_due_and_does_not_wait) {
  const auto sut = make({.rate_hz = 10}, Pace::kStepped);
  StereoFrame frame;
  const TimePoint start = time_from_ns(1'000'000'000);
  ASSERT_EQ(sut->capture(start, milliseconds(1000), frame), CaptureStatus::kFrame);
  EXPECT_EQ(sut->capture(start + milliseconds(99), milliseconds(1000), frame),
            CaptureStatus::kNothing);
  ASSERT_EQ(sut->capture(start + milliseconds(120), {}, frame), CaptureStatus::kFrame);
  EXPECT_EQ(frame.capture_time, start + milliseconds(100));
  EXPECT_EQ(frame.number, 2u);
  EXPECT_TRUE(is_complete(frame.left) && is_complete(frame.right));
}

TEST(SkeletonCamera, with_all_slots_out_the_pair_is_dropped_and_its_number_used) {
  const auto sut = make({.rate_hz = 10, .slots = 1}, Pace::kStepped);
  StereoFrame held, frame;
  const TimePoint start = time_from_ns(1);
  ASSERT_EQ(sut->capture(start, {}, held), CaptureStatus::kFrame);
  EXPECT_EQ(sut->capture(start + milliseconds(100), {}, frame), CaptureStatus::kNoSlot);
  held = StereoFrame{};
  ASSERT_EQ(sut->capture(start + milliseconds(200), {}, frame), CaptureStatus::kFrame);
  EXPECT_EQ(frame.number, 3u);
  EXPECT_EQ(sut->counters().dropped, 1u);
}

TEST(SkeletonCamera, live_waits_for_the_pair_or_the_time_out) {
  const auto sut = make({.rate_hz = 50}, Pace::kLive);
  StereoFrame frame;
  ASSERT_EQ(sut->capture(linux_os::monotonic_now(), milliseconds(5), frame), CaptureStatus::kFrame);
  const TimePoint first = frame.capture_time;
  ASSERT_EQ(sut->capture(linux_os::monotonic_now(), milliseconds(5000), frame),
            CaptureStatus::kFrame);
  EXPECT_EQ(frame.capture_time, first + milliseconds(20));
  EXPECT_GE(linux_os::monotonic_now(), frame.capture_time);
}

TEST(SkeletonCamera, an_odd_size_is_refused) {
  EXPECT_FALSE(SkeletonCamera::create({.width = 63}, Pace::kLive));
}

}  // namespace
}  // namespace gannet::hal
