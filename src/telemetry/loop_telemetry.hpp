// What every loop tells of itself: how often it ran, when last, and the times of its stages.
// A value that goes to the control thread through a LatestValue. RT safe.
#pragma once

#include <cstdint>

#include "platform/base/stage_timer.hpp"

namespace gannet::telemetry {

template <int N>
struct LoopTelemetry {
  std::uint64_t cycles = 0;
  TimePoint time = {};  // the loop's own, of its newest cycle
  StageTimer<N> timer;
};

}  // namespace gannet::telemetry
