// EstopInput: from the e-stop's channels, read every cycle, to the line that the supervisor is
// told. Pressing acts at once and by any channel: a level, or an edge between two cycles. Only the
// release is debounced: every channel must have been inactive, and without an edge, for
// estop_release_s. A channel that cannot be read is a stop.
//
// Two channels are the two contacts of one button, wired so that a press moves one up and the other
// down (antivalent). They may disagree while the button moves; for longer than
// estop_discrepancy_s one contact or wire is broken, and the line stays kUnknown until both have
// been seen pressed and then released.
//
// A value; the time is told to it. Servo thread; RT safe.
#pragma once

#include <cstdint>

#include "platform/base/time.hpp"
#include "src/safety/safety_config.hpp"
#include "src/safety/supervisor.hpp"

namespace gannet::safety {

class EstopInput {
 public:
  struct Channel {
    Line line = Line::kUnknown;  // now
    bool pressed = false;        // an edge to active since the last cycle …
    bool released = false;       // … and one to inactive
  };

  explicit EstopInput(const SafetyConfig& config)
      : release_(from_seconds(config.estop_release_s)),
        discrepancy_(from_seconds(config.estop_discrepancy_s)) {}

  // Once a cycle, always with the same number of channels.
  Line step(const Channel& only, TimePoint now) { return step(only, only, now); }
  Line step(const Channel& first, const Channel& second, TimePoint now);

  std::uint64_t presses() const { return presses_; }
  std::uint64_t discrepancies() const { return discrepancies_; }

 private:
  Line judge(const Channel& first, const Channel& second, TimePoint now);
  void watch_discrepancy(Line first, Line second, TimePoint now);

  Duration release_, discrepancy_;
  Line last_ = Line::kInactive;
  bool held_ = false;       // pressed, and not yet surely released
  TimePoint stirred_ = {};  // when a channel was last active or had an edge
  bool disagree_ = false;
  TimePoint disagree_since_ = {};
  bool distrusted_ = false;
  bool both_pressed_ = false;  // since then
  std::uint64_t presses_ = 0, discrepancies_ = 0;
};

}  // namespace gannet::safety
