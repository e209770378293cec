#include "src/servo/mission.hpp"

#include <array>

namespace gannet::servo {
namespace {

MissionMemory visiting(int visit, TimePoint now) {
  return {.state = MissionState::kRunning, .visit = visit, .visit_since = now};
}

// Between visits a new target is searched for: that is no pause.
void wait_for_target(MissionMemory& memory) {
  memory.there = false;
  if (memory.seen) memory.state = MissionState::kPaused;
}

}  // namespace

const char* to_string(MissionState state) {
  constexpr std::array<const char*, kMissionStates> kNames = {"idle",      "running", "paused",
                                                              "timed_out", "done",    "stopped"};
  return kNames[static_cast<std::size_t>(state)];
}

bool is_under_way(MissionState state) {
  return state == MissionState::kRunning || state == MissionState::kPaused ||
         state == MissionState::kTimedOut;
}

MissionMemory start_mission(const MissionMemory& memory, int visits, bool armed, TimePoint now) {
  const bool goes_on = memory.state == MissionState::kTimedOut;
  if (!armed || visits < 1 || (is_under_way(memory.state) && !goes_on)) return memory;
  return visiting(goes_on ? memory.visit : 0, now);
}

MissionMemory stop_mission(const MissionMemory& memory) {
  if (!is_under_way(memory.state)) return memory;
  return {.state = MissionState::kStopped, .visit = memory.visit};
}

MissionMemory step(const MissionMemory& memory, int visits, const VisitLimits& limits,
                   const MissionFacts& facts, TimePoint now) {
  if (!is_under_way(memory.state)) return memory;
  if (!facts.armed) return stop_mission(memory);
  if (memory.state == MissionState::kTimedOut) return memory;
  MissionMemory next = memory;
  if (now - memory.visit_since > limits.time_out) {
    next.state = MissionState::kTimedOut;
    next.there = false;
    return next;
  }
  if (!facts.following || !facts.target_sure) {
    wait_for_target(next);
    return next;
  }
  next.state = MissionState::kRunning;
  next.seen = true;
  // Written so that what is no number is not there.
  next.there = facts.error_m <= limits.tolerance_m;
  if (!next.there) return next;
  next.arrived = true;
  if (!memory.there) next.there_since = now;
  if (now - next.there_since < limits.hold) return next;
  if (memory.visit + 1 < visits) return visiting(memory.visit + 1, now);
  next.state = MissionState::kDone;  // its goal is held on
  return next;
}

}  // namespace gannet::servo
