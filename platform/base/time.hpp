// Time as a type: nanoseconds of CLOCK_MONOTONIC, or of the stepped clock that stands in for it.
// A TimePoint never mixes with the wall clock. RT safe.
#pragma once

#include <chrono>
#include <cstdint>

namespace gannet {

using Duration = std::chrono::nanoseconds;

// The epoch of CLOCK_MONOTONIC. It has no now(): pure rooms are told the time.
struct MonotonicEpoch {
  using rep = Duration::rep;
  using period = Duration::period;
  using duration = Duration;
  static constexpr bool is_steady = true;
};
using TimePoint = std::chrono::time_point<MonotonicEpoch, Duration>;

constexpr TimePoint time_from_ns(std::int64_t ns) { return TimePoint(Duration(ns)); }
constexpr std::int64_t to_ns(TimePoint t) { return t.time_since_epoch().count(); }
constexpr double to_seconds(Duration d) { return std::chrono::duration<double>(d).count(); }
constexpr Duration from_seconds(double s) {
  return Duration(static_cast<std::int64_t>(s * 1e9 + (s < 0 ? -0.5 : 0.5)));
}

}  // namespace gannet
