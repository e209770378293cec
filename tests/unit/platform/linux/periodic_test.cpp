#include "platform/linux/periodic.hpp"

#include <gtest/gtest.h>

#include "platform/linux/clock.hpp"

namespace gannet::linux_os {
namespace {

using std::chrono::milliseconds;

const TimePoint kStart = time_from_ns(1'000'000'000);

TEST(Periodic, follows_start_plus_multiples_of_the_period) {
  Periodic sut(kStart, milliseconds(10));
  TimePoint now = kStart;
  for (int i = 0; i < 5; ++i) {
    const auto wake = sut.plan(now);
    EXPECT_EQ(wake.due, kStart + i * milliseconds(10));
    EXPECT_EQ(wake.missed, 0);
    now = wake.due + milliseconds(3 + i);  // work of changing length does not shift it
  }
  EXPECT_EQ(sut.overruns(), 0u);
}

TEST(Periodic, skips_what_it_missed_and_counts_it_once) {
  Periodic sut(kStart, milliseconds(10));
  sut.plan(kStart);
  const auto late = sut.plan(kStart + milliseconds(47));  // 10, 20, 30 are gone, 40 is served
  EXPECT_EQ(late.due, kStart + milliseconds(40));
  EXPECT_EQ(late.missed, 3);
  const auto next = sut.plan(kStart + milliseconds(48));
  EXPECT_EQ(next.due, kStart + milliseconds(50));
  EXPECT_EQ(next.missed, 0);
  EXPECT_EQ(sut.overruns(), 3u);
}

TEST(Periodic, serves_a_period_that_is_late_by_less_than_one) {
  Periodic sut(kStart, milliseconds(10));
  sut.plan(kStart);
  const auto wake = sut.plan(kStart + milliseconds(19));
  EXPECT_EQ(wake.due, kStart + milliseconds(10));
  EXPECT_EQ(wake.missed, 0);
}

TEST(Periodic, waits_until_the_time_is_there) {
  const TimePoint start = monotonic_now() + milliseconds(2);
  Periodic sut(start, milliseconds(2));
  for (int i = 0; i < 5; ++i) {
    const auto wake = sut.wait();
    EXPECT_GE(monotonic_now(), wake.due);
    EXPECT_GE(wake.late.count(), 0);
  }
}

}  // namespace
}  // namespace gannet::linux_os
