#include "hal/camera/simulated_camera.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <thread>

#include "platform/linux/clock.hpp"

namespace gannet::hal {
namespace {

using std::chrono::milliseconds;

class SimulatedCameraTest : public ::testing::Test {
 protected:
  SimulatedCameraTest() {
    config_.name =
        std::string(::testing::TempDir()) + "simulated_camera_" + std::to_string(getpid());
    config_.connect_timeout_s = 5;
    config_.silence_s = 0.1;
  }
  ~SimulatedCameraTest() override { ::unlink(config_.name.c_str()); }

  SharedFramesWriter make_world(int width = 16) const {
    SharedFramesFormat format;
    format.width = width;
    format.height = 8;
    return std::move(SharedFramesWriter::create(config_.name, format)).value();
  }
  // The camera outlives frame_; a second one replaces the first.
  StereoCamera* make(Pace pace) {
    frame_ = StereoFrame{};
    auto camera = SimulatedCamera::create(config_, pace);
    const auto started = (*camera)->start();
    EXPECT_TRUE(started) << started.error().text;
    camera_ = std::move(*camera);
    return camera_.get();
  }
  static void put(SharedFramesWriter& world, TimePoint capture, Duration latency) {
    if (const auto images = world.begin_frame())
      std::memset(images->left.data(), 50, images->left.size());
    world.publish(capture, capture + latency);
  }
  // A world in a process of its own that publishes every 5 ms until it is killed.
  pid_t spawn_world() const {
    const pid_t child = ::fork();
    if (child != 0) return child;
    auto world = make_world();
    for (;;) {
      put(world, linux_os::monotonic_now(), {});
      std::this_thread::sleep_for(milliseconds(5));
    }
  }
  // Captures until the status is seen, at most for 5 s.
  static bool until(StereoCamera& sut, CaptureStatus wanted, StereoFrame& frame) {
    const TimePoint end = linux_os::monotonic_now() + std::chrono::seconds(5);
    while (linux_os::monotonic_now() < end)
      if (sut.capture(linux_os::monotonic_now(), milliseconds(20), frame) == wanted) return true;
    return false;
  }
  static TimePoint at_ms(std::int64_t ms) { return time_from_ns(ms * 1'000'000); }

  SimulatedCameraConfig config_;
  std::unique_ptr<StereoCamera> camera_;
  StereoFrame frame_;
};

TEST_F(SimulatedCameraTest, stepped_frames_appear_after_their_latency) {
  auto world = make_world();
  StereoCamera* const sut = make(Pace::kStepped);
  EXPECT_EQ(sut->width(), 16);
  EXPECT_EQ(sut->height(), 8);
  put(world, at_ms(100), milliseconds(40));
  EXPECT_EQ(sut->capture(at_ms(139), milliseconds(100), frame_), CaptureStatus::kNothing);
  ASSERT_EQ(sut->capture(at_ms(140), {}, frame_), CaptureStatus::kFrame);
  EXPECT_EQ(frame_.capture_time, at_ms(100));
  EXPECT_EQ(frame_.left.plane[0][0], 50);
}

TEST_F(SimulatedCameraTest, stepped_silence_is_a_loss_by_the_stepped_clock_and_counted_once) {
  auto world = make_world();
  StereoCamera* const sut = make(Pace::kStepped);
  put(world, at_ms(100), {});
  ASSERT_EQ(sut->capture(at_ms(100), {}, frame_), CaptureStatus::kFrame);
  EXPECT_EQ(sut->capture(at_ms(200), {}, frame_), CaptureStatus::kNothing);
  EXPECT_EQ(sut->capture(at_ms(201), {}, frame_), CaptureStatus::kLost);
  EXPECT_EQ(sut->capture(at_ms(210), {}, frame_), CaptureStatus::kLost);
  EXPECT_EQ(sut->counters().lost, 1u);
  put(world, at_ms(220), {});
  EXPECT_EQ(sut->capture(at_ms(230), {}, frame_), CaptureStatus::kFrame);
}

TEST_F(SimulatedCameraTest, live_a_killed_world_is_lost_and_a_new_one_is_found) {
  pid_t world = spawn_world();
  StereoCamera* const sut = make(Pace::kLive);
  ASSERT_TRUE(until(*sut, CaptureStatus::kFrame, frame_));
  ::kill(world, SIGKILL);
  ::waitpid(world, nullptr, 0);
  ASSERT_TRUE(until(*sut, CaptureStatus::kLost, frame_));
  EXPECT_EQ(frame_.left.plane[0][0], 50);  // what is held stays readable
  frame_ = StereoFrame{};
  world = spawn_world();
  EXPECT_TRUE(until(*sut, CaptureStatus::kFrame, frame_));
  EXPECT_EQ(sut->counters().lost, 1u);
  ::kill(world, SIGKILL);
  ::waitpid(world, nullptr, 0);
}

TEST_F(SimulatedCameraTest, live_the_end_of_the_world_is_seen_at_once) {
  config_.silence_s = 1000;
  StereoCamera* sut = nullptr;
  {
    auto world = make_world();
    sut = make(Pace::kLive);
    put(world, linux_os::monotonic_now(), {});
  }
  ASSERT_TRUE(until(*sut, CaptureStatus::kFrame, frame_));  // the last one is not lost
  EXPECT_TRUE(until(*sut, CaptureStatus::kLost, frame_));
}

TEST_F(SimulatedCameraTest, live_a_world_of_another_size_is_refused_and_told) {
  StereoCamera* sut = nullptr;
  {
    auto world = make_world();
    sut = make(Pace::kLive);
  }
  ASSERT_TRUE(until(*sut, CaptureStatus::kLost, frame_));
  ::testing::internal::CaptureStderr();
  auto other = make_world(32);
  for (int i = 0; i < 20; ++i) {
    put(other, linux_os::monotonic_now(), {});
    EXPECT_EQ(sut->capture(linux_os::monotonic_now(), milliseconds(10), frame_),
              CaptureStatus::kLost);
  }
  camera_.reset();
  EXPECT_NE(::testing::internal::GetCapturedStderr().find("another size"), std::string::npos);
}

TEST_F(SimulatedCameraTest, live_waiting_ends_with_the_frame_or_the_time_out) {
  config_.silence_s = 1000;
  auto world = make_world();
  StereoCamera* const sut = make(Pace::kLive);
  const TimePoint start = linux_os::monotonic_now();
  EXPECT_EQ(sut->capture(start, milliseconds(15), frame_), CaptureStatus::kNothing);
  EXPECT_GE(linux_os::monotonic_now() - start, milliseconds(15));
  put(world, linux_os::monotonic_now(), milliseconds(30));
  ASSERT_EQ(sut->capture(linux_os::monotonic_now(), milliseconds(5000), frame_),
            CaptureStatus::kFrame);
  const Duration age = linux_os::monotonic_now() - frame_.capture_time;
  EXPECT_GE(age, milliseconds(30));
  EXPECT_LT(age, milliseconds(2000));
}

TEST_F(SimulatedCameraTest, without_a_world_the_start_says_what_to_do) {
  config_.connect_timeout_s = 0.02;
  const auto sut = std::move(SimulatedCamera::create(config_, Pace::kLive)).value();
  const auto started = sut->start();
  ASSERT_FALSE(started);
  EXPECT_NE(started.error().text.find(config_.name), std::string::npos);
  EXPECT_NE(started.error().text.find("does gannet-world run?"), std::string::npos);
}

}  // namespace
}  // namespace gannet::hal
