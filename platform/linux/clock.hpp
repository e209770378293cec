// Clock as a kind: live is CLOCK_MONOTONIC, stepped stands still until the world moves it on.
// Loops are given one; pure rooms are given its times. Owned by the daemon's wiring. RT safe.
#pragma once

#include <time.h>

#include <atomic>

#include "platform/base/time.hpp"

namespace gannet::linux_os {

inline TimePoint monotonic_now() {
  timespec t = {};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return time_from_ns(t.tv_sec * std::int64_t{1'000'000'000} + t.tv_nsec);
}

class Clock {
 public:
  virtual ~Clock() = default;
  virtual TimePoint now() const = 0;
};

class LiveClock final : public Clock {
 public:
  TimePoint now() const override { return monotonic_now(); }
};

// set belongs to one thread, now to any.
class SteppedClock final : public Clock {
 public:
  TimePoint now() const override { return time_from_ns(now_ns_.load(std::memory_order_acquire)); }
  // Time never goes back: an earlier one is refused.
  bool set(TimePoint t) {
    if (t < now()) return false;
    now_ns_.store(to_ns(t), std::memory_order_release);
    return true;
  }

 private:
  std::atomic<std::int64_t> now_ns_{0};
};

}  // namespace gannet::linux_os
