#include "hal/camera/v4l2_judge.hpp"

#include <gtest/gtest.h>

#include "platform/base/random.hpp"

namespace gannet::hal {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kWhole = 100;

TimePoint at_ms(std::int64_t ms) { return time_from_ns((1'000'000 + ms) * 1'000'000); }

v4l2_buffer buffer(TimePoint stamp, std::uint32_t sequence,
                   std::uint32_t flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC) {
  v4l2_buffer b = {};
  b.bytesused = kWhole;
  b.flags = flags;
  b.sequence = sequence;
  b.timestamp.tv_sec = to_ns(stamp) / 1'000'000'000;
  b.timestamp.tv_usec = to_ns(stamp) % 1'000'000'000 / 1000;
  return b;
}

class V4l2JudgeTest : public ::testing::Test {
 protected:
  // A stream that has run for a while; its next frame is number 10 at 1000 ms.
  V4l2JudgeTest() {
    for (std::uint32_t i = 0; i < 10; ++i)
      EXPECT_EQ(sut_.judge(buffer(at_ms(900 + 10 * i), i), at_ms(901 + 10 * i)), V4l2Fault::kNone);
  }
  V4l2Fault judge(const v4l2_buffer& b) { return sut_.judge(b, at_ms(1001)); }
  V4l2Judge sut_{kWhole, false};
};

TEST_F(V4l2JudgeTest, the_next_frame_is_good) {
  EXPECT_EQ(judge(buffer(at_ms(1000), 10)), V4l2Fault::kNone);
  EXPECT_EQ(sut_.stamp(), at_ms(1000));
  EXPECT_EQ(sut_.missed(), 0u);
}

TEST_F(V4l2JudgeTest, the_driver_s_error_flag_counts_first) {
  auto b = buffer(at_ms(1000), 10);
  b.flags |= V4L2_BUF_FLAG_ERROR;
  b.bytesused = 0;
  EXPECT_EQ(judge(b), V4l2Fault::kErrorFlag);
}

TEST_F(V4l2JudgeTest, a_missing_byte_makes_a_frame_short) {
  auto b = buffer(at_ms(1000), 10);
  b.bytesused = kWhole - 1;
  EXPECT_EQ(judge(b), V4l2Fault::kShort);
}

TEST_F(V4l2JudgeTest, a_repeated_stamp_is_frozen) {
  EXPECT_EQ(judge(buffer(at_ms(990), 10)), V4l2Fault::kFrozen);
}

TEST_F(V4l2JudgeTest, an_older_stamp_is_backward_and_does_not_become_the_measure) {
  EXPECT_EQ(judge(buffer(at_ms(500), 10)), V4l2Fault::kBackward);
  EXPECT_EQ(judge(buffer(at_ms(990), 11)), V4l2Fault::kFrozen);
  EXPECT_EQ(judge(buffer(at_ms(1000), 12)), V4l2Fault::kNone);
}

TEST_F(V4l2JudgeTest, a_stamp_a_frame_s_time_ahead_is_good_and_far_ahead_is_off_the_clock) {
  EXPECT_EQ(judge(buffer(at_ms(1035), 10)), V4l2Fault::kNone);
  EXPECT_EQ(judge(buffer(at_ms(1500), 11)), V4l2Fault::kOffClock);
  EXPECT_EQ(judge(buffer(at_ms(1040), 12)), V4l2Fault::kNone);  // the far one left no trace
}

TEST_F(V4l2JudgeTest, a_new_stamp_from_long_ago_is_off_the_clock) {
  EXPECT_EQ(sut_.judge(buffer(at_ms(1000), 10), at_ms(3000)), V4l2Fault::kOffClock);
}

TEST_F(V4l2JudgeTest, stamps_near_two_to_the_63_do_not_overflow) {
  auto b = buffer(at_ms(1000), 10);
  for (const std::int64_t seconds :
       {std::int64_t{9'223'372'036}, std::int64_t{9'000'000'000}, std::int64_t{-1},
        std::int64_t{-9'223'372'036}, INT64_MAX, INT64_MIN}) {
    b.timestamp.tv_sec = seconds;
    b.timestamp.tv_usec = INT64_MAX;
    const V4l2Fault fault = judge(b);
    EXPECT_TRUE(fault == V4l2Fault::kOffClock) << seconds;
  }
  EXPECT_EQ(judge(buffer(at_ms(1000), 11)), V4l2Fault::kNone);
}

TEST_F(V4l2JudgeTest, a_clock_without_name_is_believed_only_if_that_is_allowed) {
  EXPECT_EQ(judge(buffer(at_ms(1000), 10, V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN)), V4l2Fault::kOffClock);
  V4l2Judge trusting(kWhole, true);
  EXPECT_EQ(trusting.judge(buffer(at_ms(0), 0, V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN), at_ms(1)),
            V4l2Fault::kNone);
  EXPECT_EQ(trusting.judge(buffer(at_ms(10), 1, V4L2_BUF_FLAG_TIMESTAMP_COPY), at_ms(11)),
            V4l2Fault::kOffClock);
  EXPECT_EQ(trusting.judge(buffer(at_ms(20), 2), at_ms(21)), V4l2Fault::kNone);
}

TEST_F(V4l2JudgeTest, a_gap_in_the_numbers_is_counted) {
  judge(buffer(at_ms(1000), 13));
  EXPECT_EQ(sut_.missed(), 3u);
}

TEST_F(V4l2JudgeTest, numbers_that_repeat_go_back_or_jump_far_say_nothing) {
  for (const std::uint32_t sequence : {9u, 3u, 0u, 2'000'000u}) {
    judge(buffer(at_ms(1000), sequence));
    EXPECT_EQ(sut_.missed(), 0u) << sequence;
  }
}

TEST(V4l2Judge, numbers_wrap_without_a_gap_and_gaps_over_the_wrap_are_seen) {
  V4l2Judge sut(kWhole, false);
  const std::uint32_t first = 0xffffff80;
  std::uint32_t missed = 0;
  for (std::uint32_t i = 0; i < 300; ++i) {
    if (i == 130) continue;
    sut.judge(buffer(at_ms(10 * i), first + i), at_ms(10 * i + 1));
    missed += sut.missed();
  }
  EXPECT_EQ(missed, 1u);
}

TEST(V4l2Judge, the_wrong_number_of_a_loop_back_s_first_frame_is_no_gap) {
  V4l2Judge sut(kWhole, false);
  sut.judge(buffer(at_ms(0), 0), at_ms(1));
  sut.judge(buffer(at_ms(10), 77), at_ms(11));
  EXPECT_EQ(sut.missed(), 0u);
  sut.judge(buffer(at_ms(20), 79), at_ms(21));
  EXPECT_EQ(sut.missed(), 1u);
}

// Whatever a driver says: what passes is whole, newer than all before it, and near our clock.
TEST(V4l2Judge, nothing_old_short_or_far_ever_passes) {
  Random random(7);
  for (int run = 0; run < 50; ++run) {
    V4l2Judge sut(kWhole, random.below(2) == 0);
    TimePoint newest = {};
    std::uint64_t good = 0, faults = 0;
    CaptureCounters counters;
    for (int i = 0; i < 400; ++i) {
      const TimePoint now = at_ms(20 * i);
      auto b = buffer(now, static_cast<std::uint32_t>(i));
      if (random.below(4) == 0) b.timestamp.tv_usec = static_cast<long>(random.below(1'000'000));
      if (random.below(8) == 0) b.timestamp.tv_sec += static_cast<long>(random.below(5)) - 2;
      if (random.below(8) == 0) b.flags = static_cast<std::uint32_t>(random.below(0x80000));
      if (random.below(8) == 0)
        b.bytesused = static_cast<std::uint32_t>(random.below(2 * static_cast<int>(kWhole)));
      if (random.below(8) == 0) b.sequence = static_cast<std::uint32_t>(random.below(INT32_MAX));
      const V4l2Fault fault = sut.judge(b, now);
      count(fault, counters);
      if (fault != V4l2Fault::kNone) {
        ++faults;
        continue;
      }
      ++good;
      EXPECT_GE(b.bytesused, kWhole);
      EXPECT_EQ(b.flags & V4L2_BUF_FLAG_ERROR, 0u);
      EXPECT_GT(sut.stamp(), newest);
      EXPECT_LE(std::chrono::abs(sut.stamp() - now), milliseconds(1000));
      EXPECT_LE(sut.missed(), 1000u);
      newest = sut.stamp();
    }
    EXPECT_GT(good, 20u);
    EXPECT_EQ(counters.broken, faults);
    EXPECT_EQ(counters.error_flagged + counters.short_frames + counters.frozen + counters.backward +
                  counters.off_clock,
              faults);
  }
}

}  // namespace
}  // namespace gannet::hal
