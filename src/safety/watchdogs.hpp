// Watchdogs: values that notice silence and overruns; the time is told to them. They count, they
// do not act: the supervisor does. Servo thread; RT safe.
#pragma once

#include <cstdint>

#include "platform/base/time.hpp"

namespace gannet::safety {

// Watches the age of something that should come again and again.
class AgeWatch {
 public:
  explicit AgeWatch(Duration limit) : limit_(limit) {}

  void feed(TimePoint time);  // it came; older times than the newest are ignored
  bool fresh(TimePoint now);  // ever fed, and not longer ago than the limit; counts the lapses
  Duration age(TimePoint now) const;                // Duration::max() before the first feed
  std::uint64_t lapses() const { return lapses_; }  // fresh → not fresh
  void set_limit(Duration limit) { limit_ = limit; }

 private:
  Duration limit_;
  TimePoint newest_ = {};
  bool fed_ = false;
  bool was_fresh_ = false;
  std::uint64_t lapses_ = 0;
};

// A limit that may be exceeded for a short while: a motor that starts, a reading that is wrong.
class LimitWatch {
 public:
  explicit LimitWatch(Duration patience) : patience_(patience) {}

  bool exceeded(bool over, TimePoint now);  // once a cycle; over without a gap for longer

 private:
  Duration patience_;
  bool over_ = false;
  TimePoint since_ = {};
};

// Missed periods within a window. The window is kept in ten parts, so it is exact to a tenth.
class OverrunWatch {
 public:
  OverrunWatch(int limit, Duration window) : limit_(limit), part_(window / kParts) {}

  void note(int missed, TimePoint now);  // once a cycle, also with 0
  bool exceeded(TimePoint now);          // at least limit within the window
  std::uint64_t total() const { return total_; }

 private:
  static constexpr int kParts = 10;
  void advance(TimePoint now);

  int limit_;
  Duration part_;
  std::int64_t newest_part_ = 0;
  int counts_[kParts] = {};
  std::uint64_t total_ = 0;
};

}  // namespace gannet::safety
