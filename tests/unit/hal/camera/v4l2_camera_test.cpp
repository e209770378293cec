// The V4L2 cameras against played drivers: pairs and halves, faults, unplugging, decoding.
#include "hal/camera/v4l2_camera.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>

#include "hal/camera/pixel_access.hpp"
#include "hal/camera/v4l2_side_by_side.hpp"
#include "platform/base/random.hpp"
#include "platform/linux/clock.hpp"
#include "tests/support/heap_calls.hpp"
#include "tests/support/scripted_v4l2.hpp"

namespace gannet::hal {
namespace {

using std::chrono::milliseconds;
using Frame = test::ScriptedV4l2::Frame;
using Device = test::ScriptedV4l2::Device;

const V4l2StreamConfig kStream = {
    .width = 16, .height = 4, .rate_hz = 50, .connect_timeout_s = 0.05};

class V4l2CameraTest : public ::testing::Test {
 protected:
  std::string start(Result<std::unique_ptr<StereoCamera>> made) {
    if (!made) return made.error().text;
    sut_ = std::move(*made);
    const auto started = sut_->start();
    return started ? "started" : started.error().text;
  }
  CaptureStatus capture(Duration timeout = milliseconds(100)) {
    // Without the played driver's own, which keeps lists.
    const std::uint64_t before = test::heap_calls - system_.heap_calls();
    const CaptureStatus status = sut_->capture(system_.now(), timeout, frame_);
    heap_calls_ += test::heap_calls - system_.heap_calls() - before;
    return status;
  }
  // Captures, giving back at once, until the status comes; at most for 5 s of real time.
  bool until(CaptureStatus wanted) {
    const TimePoint end = linux_os::monotonic_now() + std::chrono::seconds(5);
    while (linux_os::monotonic_now() < end) {
      frame_ = StereoFrame{};
      const CaptureStatus status = capture();
      if (status == wanted) return true;
      // The opener and the decoder live in real time.
      if (status != CaptureStatus::kFrame) ::usleep(1000);
    }
    return false;
  }

  test::ScriptedV4l2 system_;
  std::unique_ptr<StereoCamera> sut_;
  StereoFrame frame_;  // goes home before the camera ends
  std::uint64_t heap_calls_ = 0;
};

class V4l2PairTest : public V4l2CameraTest {
 protected:
  std::string start_pair() { return start(make_v4l2_pair(config_, nullptr, Pace::kLive, system_)); }
  Device& left_ = system_.add("left");
  Device& right_ = system_.add("right");
  V4l2PairConfig config_ = {.left = "left", .right = "right", .stream = kStream};
};

TEST_F(V4l2PairTest, gives_the_drivers_buffers_of_one_time) {
  ASSERT_EQ(start_pair(), "started");
  EXPECT_EQ(sut_->width(), 16);
  EXPECT_EQ(sut_->height(), 4);
  right_.alter = [](Frame& frame) { return frame.fill += 100, true; };
  for (std::uint8_t i = 1; i <= 20; ++i) {
    ASSERT_EQ(capture(), CaptureStatus::kFrame);
    EXPECT_EQ(frame_.left.plane[0][0], i);
    EXPECT_EQ(frame_.right.plane[0][0], i + 100);
    EXPECT_EQ(frame_.number, i);
    EXPECT_EQ(frame_.capture_time, system_.now() - milliseconds(1));
    EXPECT_TRUE(is_complete(frame_.left) && is_complete(frame_.right));
  }
  EXPECT_EQ(sut_->counters().frames, 20u);
  EXPECT_EQ(sut_->counters().broken, 0u);
}

TEST_F(V4l2PairTest, waits_out_the_time_and_no_longer) {
  left_.period = right_.period = milliseconds(300);
  ASSERT_EQ(start_pair(), "started");
  const TimePoint begin = system_.now();
  EXPECT_EQ(capture(milliseconds(50)), CaptureStatus::kNothing);
  EXPECT_EQ(system_.now(), begin + milliseconds(50));
  EXPECT_EQ(capture(milliseconds(500)), CaptureStatus::kFrame);
  EXPECT_EQ(system_.now(), begin + milliseconds(301));
}

TEST_F(V4l2PairTest, the_skew_is_measured_and_the_middle_taken) {
  config_.pair_tolerance_s = 0.009;
  right_.alter = [](Frame& frame) { return frame.stamp += milliseconds(4), true; };
  right_.latency = milliseconds(6);
  ASSERT_EQ(start_pair(), "started");
  ASSERT_EQ(capture(), CaptureStatus::kFrame);
  EXPECT_EQ(frame_.capture_time, system_.now() - milliseconds(4));
  EXPECT_DOUBLE_EQ(sut_->counters().skew_s, 0.004);
  EXPECT_DOUBLE_EQ(sut_->counters().skew_max_s, 0.004);
}

TEST_F(V4l2PairTest, a_camera_that_delivers_late_is_waited_for) {
  right_.latency = milliseconds(16);
  ASSERT_EQ(start_pair(), "started");
  for (int i = 1; i <= 20; ++i) {
    ASSERT_EQ(capture(), CaptureStatus::kFrame);
    EXPECT_EQ(frame_.left.plane[0][0], frame_.right.plane[0][0]);
  }
  EXPECT_EQ(sut_->counters().unpaired, 0u);
}

TEST_F(V4l2PairTest, stamps_too_far_apart_are_told_as_broken_with_their_skew) {
  right_.latency = milliseconds(15);
  right_.alter = [](Frame& frame) { return frame.stamp += milliseconds(9), true; };
  ASSERT_EQ(start_pair(), "started");
  for (int i = 0; i < 10; ++i) EXPECT_EQ(capture(), CaptureStatus::kBroken);
  EXPECT_GE(sut_->counters().unpaired, 9u);
  EXPECT_EQ(sut_->counters().broken, sut_->counters().unpaired);
  EXPECT_DOUBLE_EQ(sut_->counters().skew_s, 0.009);
}

TEST_F(V4l2PairTest, a_third_of_the_frames_lost_on_each_side_leaves_true_pairs) {
  const auto lossy = [](std::uint32_t one) {
    return [one](Frame& frame) { return frame.sequence % 3 != one; };
  };
  left_.alter = lossy(0), right_.alter = lossy(1);
  ASSERT_EQ(start_pair(), "started");
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(until(CaptureStatus::kFrame));
    EXPECT_EQ(frame_.left.plane[0][0], frame_.right.plane[0][0]);
  }
  const CaptureCounters counters = sut_->counters();
  EXPECT_GE(counters.missed, 30u);
  EXPECT_GE(counters.unpaired, 30u);
  EXPECT_EQ(counters.lost, 0u);
  EXPECT_EQ(counters.error_flagged + counters.off_clock + counters.frozen + counters.backward, 0u);
}

TEST_F(V4l2PairTest, unplugged_it_is_lost_and_plugged_in_again_it_is_back) {
  ASSERT_EQ(start_pair(), "started");
  ASSERT_EQ(capture(), CaptureStatus::kFrame);
  system_.unplug(right_);
  StereoFrame held = std::move(frame_);
  ASSERT_TRUE(until(CaptureStatus::kLost));
  EXPECT_EQ(held.right.plane[0][0], 1);  // what is held stays readable
  system_.plug(right_);
  // Not before all is home: its memory is the old device's.
  for (int i = 0; i < 10; ++i) EXPECT_EQ(capture(), CaptureStatus::kLost);
  held = StereoFrame{};
  ASSERT_TRUE(until(CaptureStatus::kFrame));
  EXPECT_EQ(sut_->counters().lost, 1u);
  EXPECT_EQ(left_.opened, 1);
  ASSERT_TRUE(until(CaptureStatus::kFrame));
}

TEST_F(V4l2PairTest, what_lay_in_a_buffer_is_not_taken_for_new) {
  ASSERT_EQ(start_pair(), "started");
  ASSERT_TRUE(until(CaptureStatus::kFrame));
  system_.change([&] { left_.alter = right_.alter = [](Frame&) { return false; }; });
  const std::uint64_t frames = sut_->counters().frames;
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(until(CaptureStatus::kLost));
  const TimePoint end = linux_os::monotonic_now() + milliseconds(100);
  while (linux_os::monotonic_now() < end) EXPECT_NE(capture(), CaptureStatus::kFrame);
  EXPECT_GT(left_.opened, 1);
  EXPECT_EQ(sut_->counters().frames, frames);
}

TEST_F(V4l2PairTest, while_lost_it_answers_at_the_time_out) {
  ASSERT_EQ(start_pair(), "started");
  system_.unplug(left_);
  ASSERT_TRUE(until(CaptureStatus::kLost));
  const TimePoint begin = system_.now();
  EXPECT_EQ(capture(milliseconds(70)), CaptureStatus::kLost);
  EXPECT_EQ(system_.now(), begin + milliseconds(70));
}

TEST_F(V4l2PairTest, a_failed_stream_is_started_anew) {
  ASSERT_EQ(start_pair(), "started");
  ASSERT_TRUE(until(CaptureStatus::kFrame));
  for (std::uint64_t i = 1; i <= 3; ++i) {
    system_.change([&] { left_.stream_fails = true; });
    ASSERT_TRUE(until(CaptureStatus::kLost));
    ASSERT_TRUE(until(CaptureStatus::kFrame));
    EXPECT_EQ(sut_->counters().lost, i);
  }
}

TEST_F(V4l2PairTest, both_unplugged_come_back_together) {
  ASSERT_EQ(start_pair(), "started");
  ASSERT_TRUE(until(CaptureStatus::kFrame));
  system_.unplug(left_), system_.unplug(right_);
  ASSERT_TRUE(until(CaptureStatus::kLost));
  system_.plug(left_), system_.plug(right_);
  ASSERT_TRUE(until(CaptureStatus::kFrame));
  EXPECT_EQ(sut_->counters().lost, 2u);
}

TEST_F(V4l2PairTest, silence_is_a_loss_and_so_are_frames_that_are_all_bad) {
  ASSERT_EQ(start_pair(), "started");
  ASSERT_TRUE(until(CaptureStatus::kFrame));
  system_.change([&] { left_.alter = [](Frame&) { return false; }; });
  const TimePoint begin = system_.now();
  ASSERT_TRUE(until(CaptureStatus::kLost));
  EXPECT_GE(system_.now() - begin, milliseconds(500));
  EXPECT_LE(system_.now() - begin, milliseconds(800));
  system_.change([&] { left_.alter = nullptr; });
  ASSERT_TRUE(until(CaptureStatus::kFrame));
  // What v4l2loopback gives when its writer pauses: black, with the last stamp and number.
  const TimePoint last = system_.now() - milliseconds(1);
  system_.change([&] {
    left_.alter = [last](Frame& frame) { return frame.stamp = last, frame.fill = 0, true; };
  });
  ASSERT_TRUE(until(CaptureStatus::kLost));
  EXPECT_GE(sut_->counters().frozen + sut_->counters().backward, 20u);
  EXPECT_EQ(sut_->counters().lost, 2u);
  system_.change([&] { left_.alter = nullptr; });
  ASSERT_TRUE(until(CaptureStatus::kFrame));
  EXPECT_EQ(frame_.left.plane[0][0], frame_.left.plane[0][1]);
  EXPECT_NE(frame_.left.plane[0][0], 0);
}

TEST_F(V4l2PairTest, a_device_that_comes_back_otherwise_is_refused_and_told_once) {
  ASSERT_EQ(start_pair(), "started");
  ASSERT_TRUE(until(CaptureStatus::kFrame));
  frame_ = StereoFrame{};
  ::testing::internal::CaptureStderr();
  system_.unplug(left_);
  system_.change([&] { left_.plugged = true, left_.padding = 8; });
  const TimePoint end = linux_os::monotonic_now() + milliseconds(150);
  while (linux_os::monotonic_now() < end) {
    EXPECT_NE(capture(), CaptureStatus::kFrame);
    ::usleep(2000);
  }
  sut_.reset();
  const std::string log = ::testing::internal::GetCapturedStderr();
  const std::size_t told = log.find("left: came back with another layout");
  EXPECT_NE(told, std::string::npos);
  EXPECT_EQ(log.find("left: came back", told + 1), std::string::npos);
}

TEST_F(V4l2PairTest, at_the_start_a_missing_device_is_waited_for_and_a_wrong_one_refused) {
  right_.plugged = false;
  EXPECT_EQ(start_pair(), "right: cannot open: No such file or directory");
  right_.plugged = true;
  right_.modes[0].width = 32;
  EXPECT_NE(start_pair().find("right: does not give yuyv 16 × 4 at 50 Hz"), std::string::npos);
}

TEST_F(V4l2PairTest, takes_no_heap_while_it_delivers_refuses_and_is_lost) {
  if (!test::kCountsHeap) GTEST_SKIP() << "the sanitizers bring their own heap";
  left_.alter = [](Frame& frame) {
    if (frame.sequence % 7 == 3) frame.flags |= V4L2_BUF_FLAG_ERROR;
    return true;
  };
  ASSERT_EQ(start_pair(), "started");
  int frames = 0, broken = 0;
  for (int i = 0; i < 200; ++i) {
    frame_ = StereoFrame{};
    const CaptureStatus status = capture();
    frames += status == CaptureStatus::kFrame ? 1 : 0;
    broken += status == CaptureStatus::kBroken ? 1 : 0;
  }
  system_.unplug(left_);
  ASSERT_TRUE(until(CaptureStatus::kLost));
  system_.plug(left_);
  ASSERT_TRUE(until(CaptureStatus::kFrame));
  EXPECT_GT(frames, 100);
  EXPECT_GT(broken, 20);
  EXPECT_EQ(heap_calls_, 0u);
}

// Whatever two drivers do, pairs are of one exposure, in order, and what is held stays as it is.
TEST_F(V4l2PairTest, survives_drivers_that_do_everything_wrong_at_random) {
  const auto wild = [](std::uint64_t seed) {
    auto random = std::make_shared<Random>(seed);
    return [random](Frame& frame) {
      switch (random->below(12)) {
        case 0:
          return false;
        case 1:
          frame.flags |= V4L2_BUF_FLAG_ERROR;
          break;
        case 2:
          frame.bytes = random->below(128);
          break;
        case 3:
          frame.stamp -= milliseconds(random->below(900));
          break;
        case 4:
          frame.stamp += milliseconds(random->below(60));
          break;
        case 5:
          frame.sequence = static_cast<std::uint32_t>(random->next());
          break;
        case 6:
          frame.flags = static_cast<std::uint32_t>(random->next());
          break;
        default:
          break;
      }
      return true;
    };
  };
  left_.alter = wild(1), right_.alter = wild(2);
  ASSERT_EQ(start_pair(), "started");
  TimePoint newest = {};
  std::uint64_t number = 0;
  int frames = 0;
  for (int i = 0; i < 4000; ++i) {
    frame_ = StereoFrame{};
    if (capture() != CaptureStatus::kFrame) continue;
    ++frames;
    EXPECT_GT(frame_.number, number);
    EXPECT_LE(frame_.capture_time, system_.now());
    EXPECT_GE(frame_.capture_time, newest);
    number = frame_.number;
    newest = frame_.capture_time;
  }
  EXPECT_GT(frames, 300);
  const CaptureCounters c = sut_->counters();
  EXPECT_EQ(c.broken,
            c.error_flagged + c.short_frames + c.frozen + c.backward + c.off_clock + c.unpaired);
}

class V4l2SideBySideTest : public V4l2CameraTest {
 protected:
  std::string start_halves(DecodeImage decode = nullptr) {
    return start(make_v4l2_side_by_side(config_, decode, Pace::kLive, system_));
  }
  Device& device_ = system_.add("both");
  V4l2SideBySideConfig config_ = {.device = "both", .stream = kStream};
};

TEST_F(V4l2SideBySideTest, gives_each_half_where_it_lies) {
  device_.padding = 4;
  device_.alter = [](Frame& frame) {
    for (int i = 0; i < 4 * 36; ++i) frame.content.push_back(static_cast<std::uint8_t>(i));
    return true;
  };
  ASSERT_EQ(start_halves(), "started");
  EXPECT_EQ(sut_->width(), 8);
  ASSERT_EQ(capture(), CaptureStatus::kFrame);
  EXPECT_EQ(frame_.left.width, 8);
  EXPECT_EQ(stored_at(frame_.left, 0, 1)[0], 36);
  EXPECT_EQ(stored_at(frame_.right, 0, 1)[0], 36 + 16);
  EXPECT_TRUE(frame_.left_lease.valid());
  EXPECT_FALSE(frame_.right_lease.valid());
}

TEST_F(V4l2SideBySideTest, the_right_one_may_come_first) {
  config_.right_first = true;
  device_.alter = [](Frame& frame) {
    for (int i = 0; i < 4 * 32; ++i) frame.content.push_back(static_cast<std::uint8_t>(i));
    return true;
  };
  ASSERT_EQ(start_halves(), "started");
  ASSERT_EQ(capture(), CaptureStatus::kFrame);
  EXPECT_EQ(stored_at(frame_.right, 0, 0)[0], 0);
  EXPECT_EQ(stored_at(frame_.left, 0, 0)[0], 16);
}

// The "JPEG" of these tests: its first byte is the grey of the image; 255 cannot be decoded.
Result<Image> decode_grey(std::span<const std::uint8_t> bytes) {
  if (bytes[0] == 255) return Error{"broken JPEG"};
  Image image(16, 4, PixelFormat::kYuv422);
  std::ranges::fill(image.bytes(), bytes[0]);
  return image;
}
Result<Image> decode_slowly(std::span<const std::uint8_t> bytes) {
  ::usleep(20'000);
  return decode_grey(bytes);
}

class V4l2MjpegTest : public V4l2PairTest {
 protected:
  V4l2MjpegTest() {
    config_.stream.format = "mjpeg";
    config_.stream.decode_limit_s = 10;
    left_.modes = right_.modes = {{.fourcc = V4L2_PIX_FMT_MJPEG}};
  }
  std::string start_mjpeg(DecodeImage decode = decode_grey) {
    return start(make_v4l2_pair(config_, decode, Pace::kLive, system_));
  }
};

TEST_F(V4l2MjpegTest, gives_planar_images_of_one_time) {
  ASSERT_EQ(start_mjpeg(), "started");
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(until(CaptureStatus::kFrame));
    EXPECT_EQ(frame_.left.format, PixelFormat::kYuv422);
    EXPECT_EQ(frame_.left.plane[2][0], frame_.left.plane[0][0]);
    EXPECT_EQ(frame_.left.plane[0][0], frame_.right.plane[0][0]);
    EXPECT_EQ(frame_.left.plane[0][0], frame_.number);
  }
  if (test::kCountsHeap) {
    EXPECT_EQ(heap_calls_, 0u);
  }
}

TEST_F(V4l2MjpegTest, what_cannot_be_decoded_is_counted_and_told_once) {
  right_.alter = [](Frame& frame) {
    if (frame.sequence % 2 == 1) frame.fill = 255;
    return true;
  };
  ::testing::internal::CaptureStderr();
  ASSERT_EQ(start_mjpeg(), "started");
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(until(CaptureStatus::kBroken));
    ASSERT_TRUE(until(CaptureStatus::kFrame));
  }
  EXPECT_GE(sut_->counters().undecoded, 3u);
  frame_ = StereoFrame{};
  sut_.reset();
  const std::string log = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(log.find("not decoded: broken JPEG"), std::string::npos);
  EXPECT_EQ(log.find("not decoded"), log.rfind("not decoded"));
}

TEST_F(V4l2MjpegTest, what_a_slow_decoder_cannot_take_is_dropped) {
  ASSERT_EQ(start_mjpeg(decode_slowly), "started");
  ASSERT_TRUE(until(CaptureStatus::kNoSlot));
  ASSERT_TRUE(until(CaptureStatus::kFrame));
  EXPECT_GE(sut_->counters().decoded_late, 1u);
  EXPECT_GE(sut_->counters().dropped, sut_->counters().decoded_late);
}

TEST_F(V4l2MjpegTest, what_takes_longer_than_the_limit_is_dropped) {
  config_.stream.decode_limit_s = 0.001;
  left_.period = right_.period = milliseconds(5);
  config_.pair_tolerance_s = 0.002;
  ASSERT_EQ(start_mjpeg(decode_slowly), "started");
  const TimePoint end = linux_os::monotonic_now() + std::chrono::seconds(5);
  while (sut_->counters().decoded_late < 5 && linux_os::monotonic_now() < end)
    EXPECT_NE(capture(), CaptureStatus::kFrame);
  EXPECT_GE(sut_->counters().decoded_late, 5u);
}

TEST_F(V4l2MjpegTest, is_found_again_when_it_was_unplugged) {
  ASSERT_EQ(start_mjpeg(), "started");
  ASSERT_TRUE(until(CaptureStatus::kFrame));
  system_.unplug(left_);
  ASSERT_TRUE(until(CaptureStatus::kLost));
  system_.plug(left_);
  EXPECT_TRUE(until(CaptureStatus::kFrame));
}

TEST_F(V4l2SideBySideTest, decoded_halves_are_cut_from_one_image) {
  device_.modes = {{.fourcc = V4L2_PIX_FMT_MJPEG}};
  config_.stream.format = "mjpeg";
  config_.stream.decode_limit_s = 10;
  ASSERT_EQ(start_halves(decode_grey), "started");
  ASSERT_TRUE(until(CaptureStatus::kFrame));
  EXPECT_EQ(frame_.right.plane[0], frame_.left.plane[0] + 8);
  EXPECT_EQ(frame_.right.plane[1], frame_.left.plane[1] + 4);
}

}  // namespace
}  // namespace gannet::hal
