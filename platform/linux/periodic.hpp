// Periodic: wakes a loop at start + k·period, by absolute times, so that it does not drift. Periods
// that a late loop missed are skipped, never made up for in a burst, and counted.
// Belongs to its loop's thread. RT safe.
#pragma once

#include <cstdint>

#include "platform/base/time.hpp"

namespace gannet::linux_os {

class Periodic {
 public:
  Periodic(TimePoint start, Duration period) : next_(start), period_(period) {}

  struct Wake {
    TimePoint due;            // the period's own time
    Duration late = {};       // woken after it: jitter
    std::int64_t missed = 0;  // periods skipped before this one
  };
  // Sleeps until the next period; the first is due at start.
  Wake wait();

  // The reckoning alone: what to wait for when it is now.
  Wake plan(TimePoint now);
  std::uint64_t overruns() const { return overruns_; }  // periods skipped in all

 private:
  TimePoint next_;
  const Duration period_;
  std::uint64_t overruns_ = 0;
};

}  // namespace gannet::linux_os
