#include "hal/camera/replay_camera.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "platform/linux/clock.hpp"
#include "platform/linux/whole_file.hpp"

namespace gannet::hal {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

// "width height grey" as a picture, so that hal's tests need no image library.
Result<Image> decode_text(std::span<const std::uint8_t> bytes) {
  int width = 0, height = 0, grey = 0;
  const std::string text(bytes.begin(), bytes.end());
  if (std::sscanf(text.c_str(), "%d %d %d", &width, &height, &grey) != 3)
    return Error{"ends too early"};
  Image image(width, height, PixelFormat::kRgb24);
  for (std::uint8_t& byte : image.bytes()) byte = static_cast<std::uint8_t>(grey);
  return image;
}

class ReplayCameraTest : public ::testing::Test {
 protected:
  ReplayCameraTest() { config_.directory = folder_.string(); }
  ~ReplayCameraTest() override { fs::remove_all(folder_); }

  void put(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    ASSERT_TRUE(linux_os::write_file((folder_ / name).string(), text));
  }
  // Pairs 0 … n − 1: left all 10·i, right all 10·i + 1.
  void put_pairs(int n) const {
    for (int i = 0; i < n; ++i) {
      const std::string name = std::to_string(i) + ".png", size = "8 4 ";
      put("left/" + name, size + std::to_string(10 * i));
      put("right/" + name, size + std::to_string(10 * i + 1));
    }
  }
  // The camera outlives frame_; a second one replaces the first.
  StereoCamera* make(Pace pace) {
    frame_ = StereoFrame{};
    auto camera = ReplayCamera::create(config_, decode_text, pace);
    EXPECT_TRUE(camera) << camera.error().text;
    EXPECT_TRUE((*camera)->start());
    camera_ = std::move(*camera);
    return camera_.get();
  }
  std::string error() const {
    const auto camera = ReplayCamera::create(config_, decode_text, Pace::kStepped);
    return camera ? "no error" : camera.error().text;
  }
  static TimePoint at_ms(std::int64_t ms) { return time_from_ns(ms * 1'000'000); }

  const fs::path folder_ =
      fs::path(::testing::TempDir()) / ("replay_camera_" + std::to_string(getpid()));
  ReplayCameraConfig config_;
  std::unique_ptr<StereoCamera> camera_;
  StereoFrame frame_;
};

TEST_F(ReplayCameraTest, stepped_gives_each_pair_once_when_it_is_due_and_then_ends) {
  put_pairs(3);
  config_.rate_hz = 10;
  StereoCamera* const sut = make(Pace::kStepped);
  EXPECT_EQ(sut->width(), 8);
  EXPECT_EQ(sut->height(), 4);
  ASSERT_EQ(sut->capture(at_ms(1000), {}, frame_), CaptureStatus::kFrame);
  EXPECT_EQ(sut->capture(at_ms(1099), {}, frame_), CaptureStatus::kNothing);
  // A step over several pairs gives all of them, one by one.
  for (std::uint64_t number : {2, 3}) {
    ASSERT_EQ(sut->capture(at_ms(1300), {}, frame_), CaptureStatus::kFrame);
    EXPECT_EQ(frame_.number, number);
    EXPECT_EQ(frame_.capture_time, at_ms(900 + 100 * static_cast<int>(number)));
    EXPECT_EQ(frame_.left.plane[0][0], 10 * (number - 1));
    EXPECT_EQ(frame_.right.plane[0][0], 10 * (number - 1) + 1);
  }
  EXPECT_EQ(sut->capture(at_ms(1300), {}, frame_), CaptureStatus::kFinished);
  EXPECT_EQ(sut->counters().frames, 3u);
}

TEST_F(ReplayCameraTest, times_come_from_the_file_and_a_loop_goes_on_evenly) {
  put_pairs(2);
  put("times.csv", "frame,time_s\n0,5.0\n1,5.2\n");
  config_.loop = true;
  StereoCamera* const sut = make(Pace::kStepped);
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(sut->capture(at_ms(200 * i), {}, frame_), CaptureStatus::kFrame) << i;
    EXPECT_EQ(frame_.capture_time, at_ms(200 * i));
    EXPECT_EQ(frame_.number, static_cast<std::uint64_t>(i + 1));
    EXPECT_EQ(frame_.left.plane[0][0], 10 * (i % 2));
  }
}

TEST_F(ReplayCameraTest, what_is_wrong_at_the_start_is_told_with_the_file) {
  put_pairs(2);
  put("right/0.png", "8 6 0");
  EXPECT_EQ(error(), (folder_ / "right/0.png").string() +
                         ": 8 × 6 pixels, but the first left image has 8 × 4");
  put("right/0.png", "8");
  EXPECT_EQ(error(), (folder_ / "right/0.png").string() + ": ends too early");
  fs::remove(folder_ / "right/1.png");
  EXPECT_EQ(error(), (folder_ / "left/1.png").string() + ": no right image of that name");
}

TEST_F(ReplayCameraTest, a_broken_pair_on_the_way_is_counted_and_the_next_one_comes) {
  put_pairs(3);
  put("right/1.png", "8");
  for (Pace pace : {Pace::kStepped, Pace::kLive}) {
    config_.rate_hz = 10;  // live, what comes a period late is dropped
    ::testing::internal::CaptureStderr();
    StereoCamera* const sut = make(pace);
    std::vector<CaptureStatus> seen;
    const TimePoint start = linux_os::monotonic_now();
    for (int i = 0; i < 4; ++i) {
      const TimePoint now =
          pace == Pace::kLive ? linux_os::monotonic_now() : start + milliseconds(100 * i);
      seen.push_back(sut->capture(now, milliseconds(2000), frame_));
    }
    EXPECT_EQ(seen, (std::vector{CaptureStatus::kFrame, CaptureStatus::kBroken,
                                 CaptureStatus::kFrame, CaptureStatus::kFinished}));
    EXPECT_EQ(frame_.number, 3u);
    EXPECT_EQ(sut->counters().broken, 1u);
    frame_ = StereoFrame{};
    EXPECT_NE(::testing::internal::GetCapturedStderr().find("right/1.png: ends too early"),
              std::string::npos);
  }
}

TEST_F(ReplayCameraTest, with_all_slots_out_a_stepped_pair_is_dropped) {
  put_pairs(4);
  config_.slots = 2;
  StereoCamera* const sut = make(Pace::kStepped);
  StereoFrame a, b;
  ASSERT_EQ(sut->capture(at_ms(0), {}, a), CaptureStatus::kFrame);
  ASSERT_EQ(sut->capture(at_ms(1000), {}, b), CaptureStatus::kFrame);
  EXPECT_EQ(sut->capture(at_ms(1000), {}, frame_), CaptureStatus::kNoSlot);
  a = StereoFrame{};
  ASSERT_EQ(sut->capture(at_ms(1000), {}, frame_), CaptureStatus::kFrame);
  EXPECT_EQ(frame_.number, 4u);
  EXPECT_EQ(sut->counters().dropped, 1u);
}

TEST_F(ReplayCameraTest, live_pairs_come_at_their_times_and_in_order) {
  put_pairs(6);
  config_.rate_hz = 100;
  config_.slots = 3;
  StereoCamera* const sut = make(Pace::kLive);
  std::vector<int> greys;
  for (;;) {
    const auto status = sut->capture(linux_os::monotonic_now(), milliseconds(2000), frame_);
    if (status == CaptureStatus::kFinished) break;
    ASSERT_EQ(status, CaptureStatus::kFrame);
    EXPECT_GE(linux_os::monotonic_now(), frame_.capture_time);
    greys.push_back(frame_.left.plane[0][0]);
  }
  // On a loaded machine some may have been skipped, but none is lost without being counted.
  EXPECT_TRUE(std::is_sorted(greys.begin(), greys.end()));
  EXPECT_EQ(greys.size() + sut->counters().dropped, 6u);
  EXPECT_EQ(greys.size(), sut->counters().frames);
}

TEST_F(ReplayCameraTest, live_waiting_ends_at_the_time_out) {
  put_pairs(2);
  config_.rate_hz = 0.1;
  StereoCamera* const sut = make(Pace::kLive);
  ASSERT_EQ(sut->capture(linux_os::monotonic_now(), milliseconds(2000), frame_),
            CaptureStatus::kFrame);
  const TimePoint start = linux_os::monotonic_now();
  EXPECT_EQ(sut->capture(start, milliseconds(15), frame_), CaptureStatus::kNothing);
  EXPECT_GE(linux_os::monotonic_now() - start, milliseconds(15));
}

}  // namespace
}  // namespace gannet::hal
