#include "hal/camera/shared_frames.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <thread>

#include "platform/linux/clock.hpp"

namespace gannet::hal {
namespace {

using std::chrono::milliseconds;

class SharedFrames : public ::testing::Test {
 protected:
  SharedFramesWriter make_writer(int slots = 4) const {
    SharedFramesFormat format;
    format.width = 32;
    format.height = 16;
    format.slots = slots;
    return std::move(SharedFramesWriter::create(name_, format)).value();
  }
  std::unique_ptr<SharedFramesReader> make_reader() const {
    return std::move(SharedFramesReader::open(name_)).value();
  }
  // Each byte of the pair is value; seen 10 ms after its capture.
  static bool put(SharedFramesWriter& writer, int value, TimePoint capture) {
    const auto images = writer.begin_frame();
    if (!images) return false;
    std::memset(images->left.data(), value, images->left.size());
    std::memset(images->right.data(), value + 100, images->right.size());
    writer.publish(capture, capture + milliseconds(10));
    return true;
  }
  static TimePoint at_ms(std::int64_t ms) { return time_from_ns(ms * 1'000'000); }

  const std::string name_ =
      std::string(::testing::TempDir()) + "shared_frames_" + std::to_string(getpid());
};

TEST_F(SharedFrames, a_pair_arrives_with_its_pixels_format_time_and_number) {
  auto writer = make_writer();
  auto sut = make_reader();
  ASSERT_TRUE(put(writer, 7, at_ms(100)));
  StereoFrame frame;
  ASSERT_EQ(sut->take(at_ms(110), frame), CaptureStatus::kFrame);
  EXPECT_EQ(frame.left.width, 32);
  EXPECT_EQ(frame.left.height, 16);
  EXPECT_EQ(frame.left.format, PixelFormat::kYuyv);
  EXPECT_EQ(frame.left.plane[0][32 * 16 * 2 - 1], 7);
  EXPECT_EQ(frame.right.plane[0][0], 107);
  EXPECT_EQ(frame.capture_time, at_ms(100));
  EXPECT_EQ(frame.number, 1u);
  EXPECT_EQ(sut->take(at_ms(200), frame), CaptureStatus::kNothing);
}

TEST_F(SharedFrames, a_pair_is_not_seen_before_its_time) {
  auto writer = make_writer();
  auto sut = make_reader();
  put(writer, 1, at_ms(100));
  put(writer, 2, at_ms(133));
  StereoFrame frame;
  EXPECT_EQ(sut->take(at_ms(109), frame), CaptureStatus::kNothing);
  EXPECT_EQ(sut->next_available(), at_ms(110));
  EXPECT_EQ(sut->take(at_ms(140), frame), CaptureStatus::kFrame);
  EXPECT_EQ(frame.number, 1u);
  EXPECT_EQ(sut->take(at_ms(140), frame), CaptureStatus::kNothing);
  EXPECT_EQ(sut->take(at_ms(143), frame), CaptureStatus::kFrame);
  EXPECT_EQ(frame.number, 2u);
}

TEST_F(SharedFrames, a_held_pair_is_never_overwritten) {
  auto writer = make_writer(4);
  auto sut = make_reader();
  put(writer, 1, at_ms(0));
  StereoFrame held;
  ASSERT_EQ(sut->take(at_ms(10), held), CaptureStatus::kFrame);
  for (int i = 2; i < 30; ++i) {
    ASSERT_TRUE(put(writer, i, at_ms(i)));
    ASSERT_EQ(held.left.plane[0][0], 1);
    ASSERT_EQ(held.right.plane[0][0], 101);
  }
  // Unread ones were given up, the oldest first: the newest three are there.
  StereoFrame frame;
  for (int expected : {27, 28, 29}) {
    ASSERT_EQ(sut->take(at_ms(1000), frame), CaptureStatus::kFrame);
    EXPECT_EQ(frame.left.plane[0][0], expected);
  }
  EXPECT_EQ(sut->missed(), 25u);
}

TEST_F(SharedFrames, with_all_slots_held_the_pair_is_dropped_and_shows_as_a_gap) {
  auto writer = make_writer(2);
  auto sut = make_reader();
  put(writer, 1, at_ms(0));
  put(writer, 2, at_ms(1));
  StereoFrame a, b;
  ASSERT_EQ(sut->take(at_ms(100), a), CaptureStatus::kFrame);
  ASSERT_EQ(sut->take(at_ms(100), b), CaptureStatus::kFrame);
  EXPECT_FALSE(put(writer, 3, at_ms(2)));
  EXPECT_EQ(writer.dropped(), 1u);
  b = StereoFrame{};
  StereoFrame c;
  EXPECT_EQ(sut->take(at_ms(100), c), CaptureStatus::kNothing);  // this brings b's slot home
  ASSERT_TRUE(put(writer, 4, at_ms(3)));
  ASSERT_EQ(sut->take(at_ms(100), c), CaptureStatus::kFrame);
  EXPECT_EQ(c.number, 4u);
  EXPECT_EQ(sut->missed(), 1u);
}

TEST_F(SharedFrames, a_reader_that_comes_after_a_dead_one_takes_its_slots_over) {
  auto writer = make_writer(2);
  put(writer, 1, at_ms(0));
  put(writer, 2, at_ms(1));
  const pid_t child = ::fork();
  if (child == 0) {
    auto doomed = SharedFramesReader::open(name_);
    StereoFrame a, b;
    const bool ok = doomed && (*doomed)->take(at_ms(50), a) == CaptureStatus::kFrame &&
                    (*doomed)->take(at_ms(50), b) == CaptureStatus::kFrame;
    ::_exit(ok ? 0 : 1);  // no destructor: it dies with both pairs held
  }
  int status = -1;
  ::waitpid(child, &status, 0);
  ASSERT_EQ(status, 0);
  EXPECT_FALSE(put(writer, 3, at_ms(2)));
  auto sut = make_reader();
  EXPECT_TRUE(put(writer, 4, at_ms(3)));
  StereoFrame frame;
  ASSERT_EQ(sut->take(at_ms(100), frame), CaptureStatus::kFrame);
  EXPECT_EQ(frame.number, 4u);
}

TEST_F(SharedFrames, a_second_process_that_reads_is_refused) {
  auto writer = make_writer();
  auto first = make_reader();
  const pid_t child = ::fork();
  if (child == 0) {
    const auto second = SharedFramesReader::open(name_);
    const bool refused =
        !second && second.error().text.find("reads it already") != std::string::npos;
    ::_exit(refused ? 0 : 1);
  }
  int status = -1;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  first.reset();
  EXPECT_FALSE(writer.has_reader());
}

TEST_F(SharedFrames, times_and_numbers_that_go_back_are_broken_and_given_back) {
  auto writer = make_writer();
  auto sut = make_reader();
  StereoFrame frame;
  put(writer, 1, at_ms(100));
  ASSERT_EQ(sut->take(at_ms(500), frame), CaptureStatus::kFrame);
  put(writer, 2, at_ms(99));
  EXPECT_EQ(sut->take(at_ms(500), frame), CaptureStatus::kBroken);
  writer.begin_frame();
  writer.publish(at_ms(200), at_ms(150));  // seen before it was taken
  EXPECT_EQ(sut->take(at_ms(500), frame), CaptureStatus::kBroken);
  put(writer, 4, at_ms(210));
  ASSERT_EQ(sut->take(at_ms(500), frame), CaptureStatus::kFrame);
  EXPECT_EQ(frame.number, 4u);
  frame = StereoFrame{};
  EXPECT_TRUE(sut->all_home());
}

TEST_F(SharedFrames, the_reader_wakes_when_a_pair_is_published_and_at_its_time_out) {
  auto writer = make_writer();
  auto sut = make_reader();
  const TimePoint start = linux_os::monotonic_now();
  sut->wait(sut->published(), start + milliseconds(20));
  EXPECT_GE(linux_os::monotonic_now() - start, milliseconds(20));
  const std::uint32_t seen = sut->published();
  std::thread world([&] {
    std::this_thread::sleep_for(milliseconds(20));
    put(writer, 1, linux_os::monotonic_now());
  });
  while (sut->published() == seen && linux_os::monotonic_now() - start < milliseconds(5000))
    sut->wait(seen, start + milliseconds(5000));
  EXPECT_LT(linux_os::monotonic_now() - start, milliseconds(4000));
  world.join();
}

TEST_F(SharedFrames, the_end_of_the_writer_is_seen_and_what_is_held_stays_readable) {
  std::unique_ptr<SharedFramesReader> sut;
  StereoFrame frame;
  {
    auto writer = make_writer();
    sut = make_reader();
    put(writer, 9, at_ms(0));
    ASSERT_EQ(sut->take(at_ms(10), frame), CaptureStatus::kFrame);
    EXPECT_FALSE(sut->closed());
  }
  EXPECT_TRUE(sut->closed());
  EXPECT_EQ(frame.left.plane[0][0], 9);
  EXPECT_FALSE(SharedFramesReader::open(name_));
}

TEST_F(SharedFrames, headers_that_lie_are_refused) {
  auto writer = make_writer();
  auto memory = std::move(linux_os::MappedMemory::open(name_, true)).value();
  auto& header = *reinterpret_cast<SharedHeader*>(memory.data());
  const auto refused = [&](std::uint32_t& field, std::uint32_t value) {
    const std::uint32_t good = std::exchange(field, value);
    const bool result = !SharedFramesReader::open(name_);
    field = good;
    return result;
  };
  EXPECT_TRUE(refused(header.format, 2));
  EXPECT_TRUE(refused(header.width, 0));
  EXPECT_TRUE(refused(header.width, 33));  // odd: not for YUYV
  EXPECT_TRUE(refused(header.height, 17));
  EXPECT_TRUE(refused(header.height, 0xffffffff));
  EXPECT_TRUE(refused(header.slots, 0));
  EXPECT_TRUE(refused(header.slots, 5));
  EXPECT_TRUE(refused(header.slots, 65));
  EXPECT_TRUE(refused(header.pixel_format, 7));
  EXPECT_TRUE(refused(header.matrix, 2));
  EXPECT_TRUE(refused(header.range, 2));
  ++header.magic;
  EXPECT_FALSE(SharedFramesReader::open(name_));
  --header.magic;
  EXPECT_TRUE(SharedFramesReader::open(name_));
  for (std::size_t size : {0, 1, 63, 100, 4096})
    EXPECT_FALSE(check_shared_frames({memory.data(), size}));
}

// Two threads as two processes: whoever reads a pair finds it whole.
TEST_F(SharedFrames, no_pair_is_torn_while_both_ends_run) {
  auto writer = make_writer(3);
  auto sut = make_reader();
  constexpr int kPairs = 20000;
  std::atomic<bool> ended{false};
  std::thread world([&] {
    for (int i = 1; i <= kPairs; ++i) put(writer, i % 100, at_ms(i));
    ended = true;
  });
  std::uint64_t frames = 0, torn = 0;
  for (;;) {
    const bool was_ended = ended;
    StereoFrame frame;
    if (sut->take(at_ms(10 * kPairs), frame) != CaptureStatus::kFrame) {
      if (was_ended) break;
      std::this_thread::yield();
      continue;
    }
    ++frames;
    const auto expected = static_cast<std::uint8_t>(frame.number % 100);
    for (int i = 0; i < 32 * 16 * 2; ++i) {
      torn += frame.left.plane[0][i] != expected;
      torn += frame.right.plane[0][i] != expected + 100;
    }
  }
  world.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_GT(frames, 0u);
}

}  // namespace
}  // namespace gannet::hal
