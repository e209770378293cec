// Check: a statement about a run that must hold, read from a line as a person writes it:
//   settle_s < 6
//   rms_x_mm < 10 after 10 s
//   throttle = 0 after 4.1 s until 8 s
//   permit none within 20 ms of press estop    the drives are still, by the frames on the bus
//   state is stopped at 5 s
//   state faulted within 600 ms of bus off     as soon as the world heard of it
//   counted camera_broken > 5                  a counter of the daemon (gannet top), at the end
// Measures are listed in check.cpp with their meaning. Pure; any thread.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "platform/base/result.hpp"
#include "src/world/trace.hpp"

namespace gannet::world {

// The facts that a check compares, over a stretch of time.
struct Window {
  double from_s = 0;
  double until_s = 1e18;
};

struct Measure {
  const char* name;
  const char* meaning;
  // NaN: it cannot be said, and the check fails.
  double (*value)(const Trace& trace, const Window& window);
};
const std::vector<Measure>& measures();

struct Check {
  enum class Kind { kMeasure, kPermitNone, kState, kStateWithin, kCounted };
  Kind kind = Kind::kMeasure;
  std::string text;  // as written, single spaces
  const Measure* measure = nullptr;
  char comparison = '<';  // < > =
  double limit = 0;       // in the measure's unit; ms of kPermitNone and kStateWithin
  Window window;
  std::string word;   // the state, or the counter
  std::string event;  // of kPermitNone and kStateWithin
};

struct Verdict {
  std::string text;   // the check's
  std::string found;  // "4.2"
  bool passed = false;
};

Result<Check> parse_check(std::string_view text);
Verdict judge(const Check& check, const Trace& trace);

}  // namespace gannet::world
