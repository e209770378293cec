// DigitalLine: one input or output level. Kinds: gpiod, simulated. Servo thread.
// A line that cannot be read reports kUnknown, and whoever reads it chooses the safe meaning.
// RT safe.
#pragma once

#include <cstdint>

#include "platform/base/time.hpp"

namespace gannet::hal {

enum class Level : std::uint8_t { kLow, kHigh, kUnknown };

class DigitalInput {
 public:
  virtual ~DigitalInput() = default;
  // The level, and whether any edge to the active level was seen since the last call, so that a
  // press shorter than a cycle is not missed.
  struct Reading {
    Level level = Level::kUnknown;
    bool rose = false;
    bool fell = false;
    TimePoint edge_time = {};  // of the newest edge
  };
  virtual Reading read(TimePoint now) = 0;
};

class DigitalOutput {
 public:
  virtual ~DigitalOutput() = default;
  virtual bool write(bool high, TimePoint now) = 0;  // false: the line refused
};

}  // namespace gannet::hal
