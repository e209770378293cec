#include "src/daemon/watchdog_feed.hpp"

#include <gtest/gtest.h>

namespace gannet::daemon {
namespace {

using std::chrono::milliseconds;
using Say = WatchdogFeed::Say;

constexpr Duration kLimit = std::chrono::seconds(3);
const TimePoint kStart = TimePoint(std::chrono::hours(5));

// Looks every 100 ms for `duration`, while the loops that are not `hung` go on.
struct Loops {
  WatchdogFeed sut{kLimit};
  WatchdogFeed::Cycles cycles = {1, 1, 1};
  TimePoint now = kStart;
  int alive = 0, stuck = 0;
  void go_on(Duration duration, int hung = -1) {
    for (const TimePoint end = now + duration; now < end; now += milliseconds(100)) {
      for (int i = 0; i < 3; ++i) cycles[static_cast<std::size_t>(i)] += i == hung ? 0 : 1;
      const Say said = sut.look(now, cycles);
      alive += said == Say::kAlive ? 1 : 0;
      stuck += said == Say::kStuck ? 1 : 0;
    }
  }
};

TEST(WatchdogFeedTest, loops_that_go_on_are_told_three_times_within_the_limit) {
  Loops run;
  run.go_on(kLimit * 4);
  EXPECT_EQ(run.alive, 11);  // from the first second on
  EXPECT_EQ(run.stuck, 0);
}

TEST(WatchdogFeedTest, one_hung_loop_is_enough_to_say_nothing) {
  const char* names[] = {"capture", "vision", "servo"};
  for (int hung = 0; hung < 3; ++hung) {
    Loops run;
    run.go_on(kLimit);
    run.alive = 0;
    run.go_on(kLimit * 3, hung);
    // What it had done before it hung may be told once.
    EXPECT_LE(run.alive, 1) << names[hung];
    EXPECT_EQ(run.stuck, 1) << names[hung];
    EXPECT_EQ(run.sut.standing_still(), names[hung]);
  }
}

TEST(WatchdogFeedTest, the_manager_hears_nothing_for_longer_than_its_limit_after_a_hang) {
  Loops run;
  run.go_on(kLimit);
  TimePoint last_told = run.now;
  for (int i = 0; i < 200; ++i) {
    run.alive = 0;
    run.go_on(milliseconds(100), 1);
    if (run.alive > 0) last_told = run.now;
  }
  EXPECT_LT(last_told - (kStart + kLimit), kLimit / 2);
}

TEST(WatchdogFeedTest, two_loops_that_take_turns_in_hanging_are_both_seen) {
  Loops run;
  run.go_on(kLimit);
  run.go_on(kLimit, 0);
  run.go_on(kLimit, 2);
  // Both have moved since the last telling: that is all that is asked for.
  EXPECT_EQ(run.stuck, 2);
}

TEST(WatchdogFeedTest, a_loop_that_goes_on_again_is_told_again) {
  Loops run;
  run.go_on(kLimit * 2, 1);
  run.alive = 0;
  run.go_on(kLimit);
  EXPECT_GE(run.alive, 2);
  run.go_on(kLimit * 2, 1);
  EXPECT_EQ(run.stuck, 2);
}

TEST(WatchdogFeedTest, a_loop_that_never_began_is_hung) {
  WatchdogFeed sut(kLimit);
  for (TimePoint now = kStart; now < kStart + kLimit * 2; now += milliseconds(100))
    EXPECT_NE(sut.look(now, {5, 0, 7}), Say::kAlive);
  EXPECT_EQ(sut.standing_still(), "vision");
}

TEST(WatchdogFeedTest, a_manager_that_does_not_ask_is_not_told) {
  WatchdogFeed sut(Duration{});
  for (std::uint64_t i = 1; i < 100; ++i)
    EXPECT_EQ(sut.look(kStart + milliseconds(100) * i, {i, i, i}), Say::kNothing);
}

}  // namespace
}  // namespace gannet::daemon
