// Reactions: how long after each event of a run the drives were told to stand still or to turn, by
// the times of the frames on the bus, and when the daemon's state changed, as soon as the world
// heard of it (live: asked every 30 ms). Pure; any thread.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "src/world/trace.hpp"

namespace gannet::world {

struct Reaction {
  std::string event;
  double time_s = 0;
  // ms after the event and before the next one; NaN: it did not happen, or was so before.
  double still_ms = 0;
  double turning_ms = 0;
  double state_ms = 0;
  std::string state;  // the new one
};
std::vector<Reaction> reactions_of(const Trace& trace);

// From the first event of this name to the first moment at which the drives are still, provided
// that they stay so as long as the e-stop is pressed; NaN: never. 0: they were still.
double stop_ms(const Trace& trace, const std::string& event);
// To the first moment at which the daemon was heard to be in this state.
double state_ms(const Trace& trace, const std::string& event, const std::string& state);

// Events that nobody writes: the world notices that its daemon has died, and that it is back.
inline constexpr const char* kDaemonGone = "daemon gone";
inline constexpr const char* kDaemonBack = "daemon back";
bool is_noticed(std::string_view event);

std::string reactions_table(const Trace& trace);  // "" without events

}  // namespace gannet::world
