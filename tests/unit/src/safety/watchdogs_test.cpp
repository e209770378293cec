#include "src/safety/watchdogs.hpp"

#include <gtest/gtest.h>

#include <deque>

#include "platform/base/random.hpp"

namespace gannet::safety {
namespace {

TimePoint at(double s) { return time_from_ns(0) + from_seconds(s); }

TEST(AgeWatch, is_not_fresh_before_it_was_fed) {
  AgeWatch sut(from_seconds(0.1));
  EXPECT_FALSE(sut.fresh(at(0)));
  EXPECT_EQ(sut.age(at(5)), Duration::max());
  EXPECT_EQ(sut.lapses(), 0u);
}

TEST(AgeWatch, counts_each_lapse_once) {
  AgeWatch sut(from_seconds(0.1));
  for (int round = 0; round < 3; ++round) {
    sut.feed(at(round));
    EXPECT_TRUE(sut.fresh(at(round + 0.1)));
    EXPECT_FALSE(sut.fresh(at(round + 0.101)));
    EXPECT_FALSE(sut.fresh(at(round + 0.5)));
  }
  EXPECT_EQ(sut.lapses(), 3u);
}

TEST(AgeWatch, does_not_grow_older_by_old_news) {
  AgeWatch sut(from_seconds(0.1));
  sut.feed(at(2));
  sut.feed(at(1));
  EXPECT_EQ(sut.age(at(2.05)), from_seconds(0.05));
}

TEST(OverrunWatch, counts_what_lies_within_the_window_to_a_tenth_of_it) {
  Random random(3);
  OverrunWatch sut(20, from_seconds(1));
  std::deque<std::pair<double, int>> log;
  int above = 0, below = 0;
  for (int i = 1; i < 20000; ++i) {
    const double now = 100 + 0.005 * i;
    const int missed = random.below(100) < 3 + (i / 2000) % 10 ? random.below(4) : 0;
    log.emplace_back(now, missed);
    sut.note(missed, at(now));
    int whole = 0, inner = 0;
    for (const auto& [time, count] : log) {
      whole += time > now - 1.0 ? count : 0;
      inner += time > now - 0.9 ? count : 0;
    }
    while (log.front().first < now - 1.1) log.pop_front();
    if (inner >= 20) {
      EXPECT_TRUE(sut.exceeded(at(now)));
      ++above;
    }
    if (whole < 20) {
      EXPECT_FALSE(sut.exceeded(at(now)));
      ++below;
    }
  }
  EXPECT_GT(above, 50);
  EXPECT_GT(below, 50);
}

TEST(LimitWatch, endures_what_is_short_and_counts_from_the_last_gap) {
  LimitWatch sut(from_seconds(1));
  EXPECT_FALSE(sut.exceeded(false, at(10)));
  EXPECT_FALSE(sut.exceeded(true, at(11)));
  EXPECT_FALSE(sut.exceeded(true, at(12)));
  EXPECT_FALSE(sut.exceeded(false, at(12.1)));
  EXPECT_FALSE(sut.exceeded(true, at(12.2)));
  EXPECT_FALSE(sut.exceeded(true, at(13.1)));
  EXPECT_TRUE(sut.exceeded(true, at(13.3)));
  EXPECT_FALSE(sut.exceeded(false, at(13.4)));
}

TEST(OverrunWatch, forgets_after_the_window_and_keeps_the_total) {
  OverrunWatch sut(5, from_seconds(1));
  sut.note(5, at(10));
  EXPECT_TRUE(sut.exceeded(at(10.5)));
  EXPECT_FALSE(sut.exceeded(at(11.1)));
  EXPECT_EQ(sut.total(), 5u);
}

}  // namespace
}  // namespace gannet::safety
