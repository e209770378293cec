#include "src/servo/mission.hpp"

#include <array>

namespace gannet::servo {
namespace {

bool active(MissionState state) {
  return state == MissionState::kRunning || state == MissionState::kPaused;
}

}  // namespace

const char* to_string(MissionState state) {
  constexpr std::array<const char*, 5> kNames = {"idle", "running", "paused", "done", "stopped"};
  return kNames[static_cast<std::size_t>(state)];
}

MissionMemory start_mission(const MissionMemory& memory, int visits, bool armed) {
  if (!armed || visits < 1 || active(memory.state)) return memory;
  return {.state = MissionState::kRunning};
}

MissionMemory stop_mission(const MissionMemory& memory) {
  if (!active(memory.state)) return memory;
  return {.state = MissionState::kStopped, .visit = memory.visit};
}

MissionMemory step(const MissionMemory& memory, int visits, const VisitLimits& limits,
                   const MissionFacts& facts, TimePoint now) {
  if (!active(memory.state)) return memory;
  if (!facts.armed) return stop_mission(memory);
  MissionMemory next = memory;
  if (!facts.following || !facts.target_sure) {
    next.state = MissionState::kPaused;
    next.there = false;
    return next;
  }
  next.state = MissionState::kRunning;
  // Written so that what is no number is not there.
  next.there = facts.error_m <= limits.tolerance_m;
  if (!next.there) return next;
  if (!memory.there) next.there_since = now;
  if (now - next.there_since < limits.dwell) return next;
  next.there = false;
  if (++next.visit == visits) {
    next.visit = visits - 1;  // its goal is held on
    next.state = MissionState::kDone;
  }
  return next;
}

}  // namespace gannet::servo
