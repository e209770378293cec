// Mission: visits in turn, each a target at a goal until it has been held there for a while (P000
// §3.2). A pure function of its memory, this cycle's facts and the time. It only says which visit
// is due: it holds no request and so can neither arm nor move anything. Any time the supervisor is
// not armed, a mission ends, and only a person starts it anew; while the target is lost it is
// paused, and the hold begins again; a visit that takes too long waits for a person. One thread at
// a time; RT safe.
#pragma once

#include <cstdint>

#include "platform/base/time.hpp"

namespace gannet::servo {

enum class MissionState : std::uint8_t { kIdle, kRunning, kPaused, kTimedOut, kDone, kStopped };
inline constexpr int kMissionStates = 6;
const char* to_string(MissionState state);  // "idle" …

// Of one visit; the defaults never let it end.
struct VisitLimits {
  double tolerance_m = 0;  // largest distance from the goal that counts as there
  Duration hold = Duration::max();
  Duration time_out = Duration::max();  // from its beginning to its end
};

// The defaults are the bad ones.
struct MissionFacts {
  bool armed = false;        // Armed, Servoing or Holding: neither disarmed, stopped nor faulted
  bool following = false;    // full permit for the law, not for a hand
  bool target_sure = false;  // this visit's own target, locked, its estimate fresh
  double error_m = 0;        // distance from this visit's goal
};

struct MissionMemory {
  MissionState state = MissionState::kIdle;
  int visit = 0;  // that is due, from 0
  TimePoint visit_since = {};
  bool seen = false;     // its target was followed in this visit
  bool arrived = false;  // was there in this visit
  bool there = false;
  TimePoint there_since = {};
};

bool is_under_way(MissionState state);  // running, paused or timed out

// visits: ≥ 1. A mission is started only while armed; otherwise, or while it runs, the memory comes
// back as it was. One that timed out goes on with the visit that did.
MissionMemory start_mission(const MissionMemory& memory, int visits, bool armed, TimePoint now);
MissionMemory stop_mission(const MissionMemory& memory);

// Once a cycle. limits: of memory.visit.
MissionMemory step(const MissionMemory& memory, int visits, const VisitLimits& limits,
                   const MissionFacts& facts, TimePoint now);

}  // namespace gannet::servo
