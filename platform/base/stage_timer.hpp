// Times of the steps of a loop: last, mean, max, budget and percentiles from a histogram of fixed
// log-scaled buckets. The loop's thread laps; a copy of StageStats goes to readers through a
// LatestValue. Values without heap; RT safe.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "platform/base/time.hpp"

namespace gannet {

// Counts durations from 0 to 2³⁶ ns (69 s; longer ones count as that) in 16 buckets an octave: a
// percentile is right within 1/16 of its value.
class LogHistogram {
 public:
  void add(Duration d) {
    const auto bucket = static_cast<std::size_t>(bucket_of(d.count()));
    counts_[bucket] += 1;
    total_ += 1;
    max_ = std::max(max_, d);
  }
  // The upper edge of the bucket below which this share (0 … 1) of all lies, but never more than
  // the largest of all; 0 when empty.
  Duration percentile(double share) const {
    if (total_ == 0) return {};
    const auto wanted = static_cast<std::uint64_t>(share * static_cast<double>(total_));
    std::uint64_t seen = 0;
    for (int i = 0; i < kBuckets; ++i) {
      seen += counts_[static_cast<std::size_t>(i)];
      if (seen > wanted || seen == total_) return std::min(max_, Duration(upper_edge(i)));
    }
    return max_;
  }
  std::uint64_t total() const { return total_; }
  std::uint32_t count(int bucket) const { return counts_[static_cast<std::size_t>(bucket)]; }

  static constexpr int kSteps = 16;  // buckets an octave
  static constexpr int kBuckets = (36 - 4 + 1) * kSteps;
  static int bucket_of(std::int64_t ns) {
    const auto v =
        static_cast<std::uint64_t>(std::clamp<std::int64_t>(ns, 0, (std::int64_t{1} << 36) - 1));
    if (v < kSteps) return static_cast<int>(v);
    const int octave = std::bit_width(v) - 5;  // v has 5 significant bits above this shift
    return (octave + 1) * kSteps + static_cast<int>((v >> octave) & (kSteps - 1));
  }
  // The first duration beyond the bucket, ns.
  static std::int64_t upper_edge(int bucket) {
    if (bucket < kSteps) return bucket + 1;
    const int octave = bucket / kSteps - 1;
    return (std::int64_t{kSteps} + bucket % kSteps + 1) << octave;
  }

 private:
  std::array<std::uint32_t, kBuckets> counts_ = {};
  std::uint64_t total_ = 0;
  Duration max_ = {};
};

struct StageStats {
  const char* name = "";  // of a literal
  Duration budget = {};   // 0: none
  Duration last = {};
  Duration max = {};
  Duration sum = {};
  std::uint64_t count = 0;
  std::uint64_t over_budget = 0;
  LogHistogram histogram;

  void add(Duration d) {
    last = d;
    max = std::max(max, d);
    sum += d;
    count += 1;
    if (budget.count() > 0 && d > budget) over_budget += 1;
    histogram.add(d);
  }
  Duration mean() const {
    return count == 0 ? Duration{} : Duration(sum.count() / static_cast<std::int64_t>(count));
  }
};

// begin at a cycle's start, lap at the end of each step: it counts the time since the one before.
template <int N>
class StageTimer {
 public:
  void name(int stage, const char* literal, Duration budget = {}) {
    at(stage).name = literal;
    at(stage).budget = budget;
  }
  void begin(TimePoint now) { before_ = now; }
  void lap(int stage, TimePoint now) {
    at(stage).add(now - before_);
    before_ = now;
  }
  // A duration that was measured otherwise, such as that of the whole cycle.
  void add(int stage, Duration d) { at(stage).add(d); }
  const std::array<StageStats, static_cast<std::size_t>(N)>& stages() const { return stages_; }

 private:
  StageStats& at(int stage) { return stages_[static_cast<std::size_t>(stage)]; }
  std::array<StageStats, static_cast<std::size_t>(N)> stages_ = {};
  TimePoint before_;
};

}  // namespace gannet
