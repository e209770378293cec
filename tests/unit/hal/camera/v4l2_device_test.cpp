#include "hal/camera/v4l2_device.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <list>

#include "platform/base/random.hpp"
#include "tests/support/scripted_v4l2.hpp"

namespace gannet::hal {
namespace {

using std::chrono::milliseconds;
using Frame = test::ScriptedV4l2::Frame;

class V4l2DeviceTest : public ::testing::Test {
 protected:
  std::string open() {
    bool may_pass = false;
    auto opened = V4l2Device::open(system_, "cam", config_, may_pass);
    may_pass_ = may_pass;
    if (!opened) return opened.error().text;
    sut_ = std::move(*opened);
    return "open";
  }
  // The device's next answer that is not "nothing".
  V4l2Taken take(V4l2Image& image) {
    for (;;) {
      const V4l2Taken taken = sut_->take(system_.now(), counters_, image);
      if (taken != V4l2Taken::kNothing) return taken;
      pollfd fd = {sut_->fd(), POLLIN, 0};
      EXPECT_EQ(system_.poll({&fd, 1}, system_.now() + std::chrono::seconds(1)), 1);
    }
  }
  test::ScriptedV4l2 system_;
  test::ScriptedV4l2::Device& device_ = system_.add("cam");
  V4l2StreamConfig config_ = {.width = 16, .height = 4, .rate_hz = 50, .buffers = 4};
  CaptureCounters counters_;
  std::unique_ptr<V4l2Device> sut_;
  bool may_pass_ = false;
};

TEST_F(V4l2DeviceTest, lends_the_driver_s_own_buffers) {
  ASSERT_EQ(open(), "open");
  const TimePoint start = system_.now();
  V4l2Image image;
  ASSERT_EQ(take(image), V4l2Taken::kImage);
  EXPECT_EQ(image.stamp, start + milliseconds(20));
  EXPECT_EQ(image.bytes.size(), 128u);
  EXPECT_EQ(image.bytes[0], 1);
  EXPECT_EQ(image.number, 1u);
  EXPECT_EQ(system_.queued(device_), 3);
  image = V4l2Image{};
  sut_->take(system_.now(), counters_, image);
  EXPECT_EQ(system_.queued(device_), 4);
}

TEST_F(V4l2DeviceTest, the_middle_of_the_exposure_follows_from_the_stamp_s_source) {
  config_.exposure_s = 0.008;
  config_.readout_s = 0.010;
  device_.latency = milliseconds(15);
  ASSERT_EQ(open(), "open");
  V4l2Image image;
  ASSERT_EQ(take(image), V4l2Taken::kImage);
  EXPECT_EQ(image.exposure, image.stamp - milliseconds(14));
  device_.clock |= V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  ASSERT_EQ(take(image), V4l2Taken::kImage);
  EXPECT_EQ(image.exposure, image.stamp + milliseconds(4));
}

TEST_F(V4l2DeviceTest, a_stamp_in_the_future_makes_no_exposure_in_the_future) {
  device_.alter = [](Frame& frame) { return frame.stamp += milliseconds(34), true; };
  ASSERT_EQ(open(), "open");
  V4l2Image image;
  ASSERT_EQ(take(image), V4l2Taken::kImage);
  EXPECT_GT(image.stamp, system_.now());
  EXPECT_EQ(image.exposure, system_.now());
}

TEST_F(V4l2DeviceTest, the_driver_keeps_two_buffers_and_newer_images_are_dropped) {
  ASSERT_EQ(open(), "open");
  V4l2Image first, second, third;
  ASSERT_EQ(take(first), V4l2Taken::kImage);
  ASSERT_EQ(take(second), V4l2Taken::kImage);
  EXPECT_EQ(take(third), V4l2Taken::kNoSlot);
  EXPECT_EQ(take(third), V4l2Taken::kNoSlot);
  EXPECT_EQ(counters_.dropped, 2u);
  EXPECT_EQ(counters_.missed, 0u);
  first = V4l2Image{};
  ASSERT_EQ(take(third), V4l2Taken::kImage);
  EXPECT_EQ(third.number, 5u);
}

TEST_F(V4l2DeviceTest, two_buffers_are_enough_to_go_on) {
  device_.most_buffers = 2;
  ASSERT_EQ(open(), "open");
  V4l2Image image, other;
  for (int i = 0; i < 5; ++i) {
    image = V4l2Image{};
    ASSERT_EQ(take(image), V4l2Taken::kImage);
  }
  EXPECT_EQ(take(other), V4l2Taken::kNoSlot);
  sut_->take(system_.now(), counters_, other);
  image = V4l2Image{};
  EXPECT_EQ(take(other), V4l2Taken::kImage);
}

TEST_F(V4l2DeviceTest, each_fault_is_counted_and_its_buffer_given_back) {
  device_.alter = [](Frame& frame) {
    switch (frame.sequence) {
      case 1:
        frame.flags |= V4L2_BUF_FLAG_ERROR;
        break;
      case 2:
        frame.bytes = 127;
        break;
      case 3:
        frame.stamp -= milliseconds(60);
        break;  // that of number 0
      case 4:
        frame.stamp -= milliseconds(500);
        break;
      case 5:
        frame.flags = 0;
        break;
      case 6:
        return false;
      default:
        break;
    }
    return true;
  };
  ASSERT_EQ(open(), "open");
  V4l2Image image;
  ASSERT_EQ(take(image), V4l2Taken::kImage);
  for (int i = 1; i <= 5; ++i) {
    V4l2Image bad;
    EXPECT_EQ(take(bad), V4l2Taken::kRefused) << i;
    EXPECT_FALSE(bad.lease.valid());
    EXPECT_EQ(system_.queued(device_), 3) << i;
  }
  ASSERT_EQ(take(image), V4l2Taken::kImage);
  EXPECT_EQ(image.number, 8u);
  EXPECT_EQ(counters_.error_flagged, 1u);
  EXPECT_EQ(counters_.short_frames, 1u);
  EXPECT_EQ(counters_.frozen, 1u);
  EXPECT_EQ(counters_.backward, 1u);
  EXPECT_EQ(counters_.off_clock, 1u);
  EXPECT_EQ(counters_.broken, 5u);
  EXPECT_EQ(counters_.missed, 1u);
}

TEST_F(V4l2DeviceTest, a_buffer_that_the_driver_refuses_is_offered_again) {
  ASSERT_EQ(open(), "open");
  V4l2Image image;
  ASSERT_EQ(take(image), V4l2Taken::kImage);
  image = V4l2Image{};
  device_.queue_errors = 1;
  sut_->take(system_.now(), counters_, image);
  EXPECT_EQ(system_.queued(device_), 3);
  sut_->take(system_.now(), counters_, image);
  EXPECT_EQ(system_.queued(device_), 4);
}

TEST_F(V4l2DeviceTest, a_failed_stream_or_device_is_gone) {
  ASSERT_EQ(open(), "open");
  V4l2Image image;
  device_.stream_fails = true;
  EXPECT_EQ(take(image), V4l2Taken::kGone);
  sut_.reset();
  ASSERT_EQ(open(), "open");
  system_.unplug(device_);
  EXPECT_EQ(take(image), V4l2Taken::kGone);
}

// Whoever holds an image sees it unchanged, however long and in whatever order images go home.
TEST_F(V4l2DeviceTest, held_images_are_never_overwritten) {
  config_.buffers = 7;
  ASSERT_EQ(open(), "open");
  Random random(3);
  struct Held {
    V4l2Image image;
    std::uint8_t fill;
  };
  std::list<Held> held;
  for (int i = 0; i < 2000; ++i) {
    V4l2Image image;
    if (take(image) == V4l2Taken::kImage) {
      const std::uint8_t fill = image.bytes[0];
      held.push_back({std::move(image), fill});
    }
    EXPECT_GE(system_.queued(device_), 2);
    if (!held.empty() && random.below(2) == 0)
      held.erase(std::next(held.begin(), random.below(static_cast<int>(held.size()))));
    for (const Held& one : held) ASSERT_EQ(one.image.bytes[one.image.bytes.size() / 2], one.fill);
  }
  EXPECT_GT(counters_.dropped, 0u);
  EXPECT_EQ(counters_.broken, 0u);
}

TEST_F(V4l2DeviceTest, a_loop_back_that_writes_into_a_held_buffer_costs_that_image_alone) {
  device_.loops_back = true;
  ASSERT_EQ(open(), "open");
  V4l2Image held, image;
  ASSERT_EQ(take(held), V4l2Taken::kImage);
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < 3; ++i) {
      image = V4l2Image{};
      ASSERT_EQ(take(image), V4l2Taken::kImage);
    }
    image = V4l2Image{};
    ASSERT_EQ(take(image), V4l2Taken::kNoSlot);
  }
  held = V4l2Image{};
  for (int i = 0; i < 9; ++i) {
    image = V4l2Image{};
    ASSERT_EQ(take(image), V4l2Taken::kImage);
  }
  EXPECT_EQ(counters_.dropped, 3u);
}

TEST_F(V4l2DeviceTest, closing_unmaps_everything) {
  ASSERT_EQ(open(), "open");
  EXPECT_EQ(system_.mapped(), 4);
  sut_.reset();
  EXPECT_EQ(system_.mapped(), 0);
  device_.start_error = -EIO;
  EXPECT_EQ(open(), "cam: cannot start the stream: Input/output error");
  EXPECT_TRUE(may_pass_);
  EXPECT_EQ(system_.mapped(), 0);
}

TEST_F(V4l2DeviceTest, says_why_a_device_cannot_be_used) {
  device_.abilities = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  EXPECT_EQ(open(), "cam: (Scripted camera) gives no images; `gannet cameras` lists those that do");
  EXPECT_FALSE(may_pass_);
  device_.abilities = V4L2_CAP_VIDEO_CAPTURE;
  EXPECT_EQ(open(), "cam: (Scripted camera) has no mapped buffers");
  device_.abilities |= V4L2_CAP_STREAMING;
  device_.most_buffers = 1;
  EXPECT_NE(open().find("at least 2 are needed"), std::string::npos);
  device_.most_buffers = 32;
  config_.height = 6;
  EXPECT_NE(open().find("it makes 16 × 4 of it"), std::string::npos);
  EXPECT_FALSE(may_pass_);
  device_.plugged = false;
  EXPECT_EQ(open(), "cam: cannot open: No such file or directory");
  EXPECT_TRUE(may_pass_);
}

TEST_F(V4l2DeviceTest, a_nameless_clock_needs_the_config_s_consent) {
  device_.clock = V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN;
  EXPECT_NE(open().find("accept_unknown_clock = true"), std::string::npos);
  EXPECT_FALSE(may_pass_);
  config_.accept_unknown_clock = true;
  ASSERT_EQ(open(), "open");
  EXPECT_FALSE(sut_->names_its_clock());
  V4l2Image image;
  EXPECT_EQ(take(image), V4l2Taken::kImage);
}

}  // namespace
}  // namespace gannet::hal
