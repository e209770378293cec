#include "src/world/v4l2_frame_sink.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstring>
#include <map>
#include <thread>

#include "platform/linux/clock.hpp"

namespace gannet::world {
namespace {

using std::chrono::milliseconds;

// v4l2loopback's output side, as its source and hil tests have it: buffers that are shared with the
// reader, numbers modulo how many are in use, stamps as the writer gave them.
class PlayedLoopback final : public hal::V4l2System {
 public:
  struct Shown {
    TimePoint stamp, when;
    std::size_t bytes;
    std::uint8_t first, last;  // of the image
  };
  struct Device {
    std::uint32_t abilities = V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_STREAMING;
    std::uint32_t in_use = 8;  // buffers; a reader may lower it
    std::uint32_t kept_width = 0;
    std::vector<std::vector<std::uint8_t>> memory = std::vector(8, std::vector<std::uint8_t>(4096));
    bool streams = false;
    std::size_t size = 0;
    std::vector<Shown> shown;
  };
  std::map<std::string, Device> devices;
  int refuse = 0;  // QBUF with this error
  int open_fds = 0, mapped = 0;

  int open(const std::string& path) override {
    const auto found = devices.find(path);
    if (found == devices.end()) return -ENOENT;
    ++open_fds;
    return static_cast<int>(std::distance(devices.begin(), found));
  }
  void close(int) override { --open_fds; }
  void* map(int fd, std::size_t, std::int64_t offset) override {
    ++mapped;
    return of(fd).memory[static_cast<std::size_t>(offset)].data();
  }
  void unmap(void*, std::size_t) override { --mapped; }
  int poll(std::span<pollfd>, TimePoint) override { return 0; }
  TimePoint now() const override { return linux_os::monotonic_now(); }
  int ioctl(int fd, unsigned long request, void* argument) override {
    Device& device = of(fd);
    if (request == VIDIOC_QUERYCAP)
      static_cast<v4l2_capability*>(argument)->capabilities = device.abilities;
    if (request == VIDIOC_S_FMT) {
      auto& pix = static_cast<v4l2_format*>(argument)->fmt.pix;
      if (device.kept_width > 0) pix.width = device.kept_width;
      device.size = pix.sizeimage;
    }
    if (request == VIDIOC_STREAMON) device.streams = true;
    if (request == VIDIOC_QUERYBUF) {
      auto& buffer = *static_cast<v4l2_buffer*>(argument);
      buffer.index %= device.in_use;
      buffer.m.offset = buffer.index;
      buffer.length = 4096;
    }
    return request == VIDIOC_QBUF ? queue(device, *static_cast<v4l2_buffer*>(argument)) : 0;
  }

 private:
  Device& of(int fd) { return std::next(devices.begin(), fd)->second; }
  int queue(Device& device, const v4l2_buffer& buffer) {
    if (refuse != 0 || !device.streams) return -(refuse != 0 ? refuse : EINVAL);
    const auto& memory = device.memory[buffer.index % device.in_use];
    device.shown.push_back({time_from_ns(buffer.timestamp.tv_sec * std::int64_t{1'000'000'000} +
                                         buffer.timestamp.tv_usec * std::int64_t{1000}),
                            linux_os::monotonic_now(), buffer.bytesused, memory[0],
                            memory[device.size - 1]});
    return 0;
  }
};

class V4l2FrameSinkTest : public ::testing::Test {
 protected:
  static constexpr int kBytes = 16 * 4 * 2;
  void SetUp() override { system_.devices = {{"/dev/video10", {}}, {"/dev/video11", {}}}; }
  void make(bool has_thread = false) {
    auto made = V4l2FrameSink::create({.devices = {"/dev/video10", "/dev/video11"},
                                       .width = 16,
                                       .height = 4,
                                       .has_thread = has_thread},
                                      system_);
    ASSERT_TRUE(made) << made.error().text;
    owner_ = std::move(*made);
    sut_ = static_cast<V4l2FrameSink*>(owner_.get());
  }
  bool publish(std::uint8_t fill, const PairTimes& times) {
    const auto images = sut_->begin_frame();
    if (!images) return false;
    std::fill(images->left.begin(), images->left.end(), fill);
    std::fill(images->right.begin(), images->right.end(), static_cast<std::uint8_t>(fill + 1));
    sut_->publish(times);
    return true;
  }
  static PairTimes at(int stamp_ms, int left_ms, int right_ms) {
    const auto t = [](int ms) { return time_from_ns(ms * std::int64_t{1'000'000}); };
    return {{{{t(stamp_ms), t(left_ms)}, {t(stamp_ms), t(right_ms)}}}};
  }
  void hand_over(int ms) { sut_->hand_over_due(time_from_ns(ms * std::int64_t{1'000'000})); }
  std::vector<PlayedLoopback::Shown>& left() { return system_.devices["/dev/video10"].shown; }
  std::vector<PlayedLoopback::Shown>& right() { return system_.devices["/dev/video11"].shown; }

  PlayedLoopback system_;
  std::unique_ptr<FrameSink> owner_;
  V4l2FrameSink* sut_ = nullptr;
};

TEST_F(V4l2FrameSinkTest, hands_over_at_the_time_with_the_stamp_of_the_exposure) {
  make();
  ASSERT_TRUE(publish(50, at(1000, 1040, 1040)));
  hand_over(1039);
  EXPECT_TRUE(left().empty());
  hand_over(1040);
  ASSERT_EQ(left().size(), 1u);
  ASSERT_EQ(right().size(), 1u);
  EXPECT_EQ(left()[0].stamp, time_from_ns(1'000'000'000));
  EXPECT_EQ(left()[0].bytes, std::size_t{kBytes});
  EXPECT_EQ(left()[0].first, 50);
  EXPECT_EQ(left()[0].last, 50);
  EXPECT_EQ(right()[0].first, 51);
}

TEST_F(V4l2FrameSinkTest, a_late_camera_comes_later_and_its_twin_does_not_wait) {
  make();
  ASSERT_TRUE(publish(1, at(1000, 1055, 1040)));
  ASSERT_TRUE(publish(3, at(1010, 1050, 1050)));
  hand_over(1040);
  EXPECT_EQ(left().size(), 0u);
  EXPECT_EQ(right().size(), 1u);
  hand_over(1060);
  ASSERT_EQ(left().size(), 2u);
  EXPECT_EQ(left()[0].first, 3);  // by the time they are due
  EXPECT_EQ(left()[1].first, 1);
}

TEST_F(V4l2FrameSinkTest, short_frames_say_fewer_bytes) {
  make();
  PairTimes times = at(1000, 1040, 1040);
  times.is_short = true;
  ASSERT_TRUE(publish(1, times));
  hand_over(1040);
  EXPECT_EQ(left()[0].bytes, std::size_t{kBytes} / 3);
}

TEST_F(V4l2FrameSinkTest, pictures_are_right_when_the_reader_uses_fewer_buffers) {
  make();
  for (auto& [path, device] : system_.devices) device.in_use = 2;
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(publish(static_cast<std::uint8_t>(2 * i), at(i, i, i)));
    hand_over(i);
    EXPECT_EQ(left().back().first, 2 * i);
    EXPECT_EQ(right().back().first, 2 * i + 1);
  }
}

TEST_F(V4l2FrameSinkTest, no_room_is_said_and_comes_back) {
  make();
  for (int i = 0; i < 8; ++i) ASSERT_TRUE(publish(1, at(i, 100, 100)));
  EXPECT_FALSE(publish(1, at(8, 100, 100)));
  hand_over(100);
  EXPECT_TRUE(publish(1, at(9, 109, 109)));
}

TEST_F(V4l2FrameSinkTest, what_a_device_refuses_is_counted) {
  make();
  system_.refuse = EINVAL;
  ASSERT_TRUE(publish(1, at(1, 1, 1)));
  hand_over(1);
  EXPECT_EQ(sut_->refused(), 2u);
}

TEST_F(V4l2FrameSinkTest, a_thread_of_its_own_hands_over_in_time) {
  make(true);
  const TimePoint now = linux_os::monotonic_now();
  const ImageTimes image = {now, now + milliseconds(20)};
  ASSERT_TRUE(publish(7, {{{image, image}}}));
  std::this_thread::sleep_for(milliseconds(200));
  owner_.reset();  // joins
  ASSERT_EQ(left().size(), 1u);
  ASSERT_EQ(right().size(), 1u);
  EXPECT_GE(left()[0].when, now + milliseconds(20));
}

TEST_F(V4l2FrameSinkTest, says_what_is_wrong_with_a_device_and_leaves_nothing_open) {
  const auto error = [&] {
    auto made = V4l2FrameSink::create(
        {.devices = {"/dev/video10", "/dev/video11"}, .width = 16, .height = 4}, system_);
    return made ? std::string() : made.error().text;
  };
  system_.devices["/dev/video11"].abilities = V4L2_CAP_VIDEO_CAPTURE;
  EXPECT_NE(error().find("/dev/video11 takes no pictures"), std::string::npos);
  system_.devices["/dev/video11"] = {};
  system_.devices["/dev/video11"].kept_width = 640;
  EXPECT_NE(error().find("keeps another format than 16x4"), std::string::npos);
  system_.devices.erase("/dev/video11");
  EXPECT_NE(error().find("/dev/video11: open: No such file"), std::string::npos);
  EXPECT_EQ(system_.open_fds, 0);
  EXPECT_EQ(system_.mapped, 0);
}

}  // namespace
}  // namespace gannet::world
