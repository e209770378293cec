#include "platform/base/stage_timer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "platform/base/random.hpp"

namespace gannet {
namespace {

using std::chrono::microseconds;

TEST(LogHistogram, buckets_follow_one_another_without_gap) {
  std::int64_t edge = 0;
  for (int i = 0; i < LogHistogram::kBuckets; ++i) {
    EXPECT_EQ(LogHistogram::bucket_of(edge), i);
    edge = LogHistogram::upper_edge(i);
    EXPECT_EQ(LogHistogram::bucket_of(edge - 1), i);
  }
}

TEST(LogHistogram, takes_what_is_out_of_range_into_the_end_buckets) {
  LogHistogram sut;
  sut.add(Duration(-5));
  sut.add(Duration(std::int64_t{1} << 50));
  EXPECT_EQ(sut.count(0), 1u);
  EXPECT_EQ(sut.count(LogHistogram::kBuckets - 1), 1u);
}

TEST(LogHistogram, percentiles_are_right_within_a_sixteenth) {
  Random random(4);
  LogHistogram sut;
  std::vector<std::int64_t> all;
  for (int i = 0; i < 20000; ++i) {
    const auto ns = static_cast<std::int64_t>(50 + 3e6 * random.uniform() * random.uniform());
    all.push_back(ns);
    sut.add(Duration(ns));
  }
  std::sort(all.begin(), all.end());
  for (const double share : {0.01, 0.5, 0.9, 0.99, 0.999}) {
    const auto truth = all[static_cast<std::size_t>(share * 20000)];
    const auto found = sut.percentile(share).count();
    EXPECT_GE(found, truth);
    EXPECT_LE(found, truth + truth / 16 + 1);
  }
}

TEST(LogHistogram, the_last_percentile_is_the_largest_of_all) {
  LogHistogram sut;
  for (const int us : {100, 145, 130}) sut.add(microseconds(us));
  EXPECT_EQ(sut.percentile(1), microseconds(145));
  EXPECT_EQ(sut.percentile(0.99), microseconds(145));
}

TEST(LogHistogram, is_zero_when_empty) { EXPECT_EQ(LogHistogram().percentile(0.5).count(), 0); }

TEST(StageTimer, laps_measure_from_the_one_before) {
  StageTimer<2> sut;
  sut.name(0, "first");
  sut.name(1, "second", microseconds(15));
  const TimePoint t = time_from_ns(1000);
  sut.begin(t);
  sut.lap(0, t + microseconds(10));
  sut.lap(1, t + microseconds(30));
  sut.begin(t + microseconds(100));
  sut.lap(0, t + microseconds(130));
  sut.lap(1, t + microseconds(140));
  const auto& first = sut.stages()[0];
  const auto& second = sut.stages()[1];
  EXPECT_STREQ(first.name, "first");
  EXPECT_EQ(first.last, microseconds(30));
  EXPECT_EQ(first.mean(), microseconds(20));
  EXPECT_EQ(first.max, microseconds(30));
  EXPECT_EQ(first.over_budget, 0u);
  EXPECT_EQ(second.over_budget, 1u);
  EXPECT_EQ(second.count, 2u);
}

}  // namespace
}  // namespace gannet
