#include "src/safety/supervisor.hpp"

namespace gannet::safety {
namespace {

constexpr std::array<const char*, kStates> kStateNames = {
    "starting", "standby", "armed", "servoing", "holding", "stopped", "faulted"};
constexpr std::array<const char*, kCauses> kCauseNames = {"none",
                                                          "estop",
                                                          "estop_unknown",
                                                          "operator_stop",
                                                          "internal_fault",
                                                          "drive_fault",
                                                          "drives_silent",
                                                          "bus_down",
                                                          "overruns",
                                                          "limits",
                                                          "not_started",
                                                          "not_reset",
                                                          "no_vehicle",
                                                          "no_camera",
                                                          "target_none",
                                                          "target_old",
                                                          "target_uncertain",
                                                          "hold_expired",
                                                          "disarmed",
                                                          "drives_not_ready",
                                                          "drives_unguarded",
                                                          "no_estop"};

// What this cycle's inputs say, most urgent first: of all that are true, the first one that the
// present state reacts to is taken, one transition a cycle.
enum class Event : std::uint8_t {
  kEstop,  // the line is not surely inactive
  kStop,   // a person's stop
  kBug,    // an internal fault
  kFault,  // drives, bus, overruns, limits
  kDisarm,
  kReset,  // asked for, and nothing that stops is present
  kArm,    // asked for, and no obstacle
  kStarted,
  kExpired,   // this state has lasted longer than hold_limit_s
  kMotion,    // a target that may be followed, or a person's hand
  kNoMotion,  // neither
};
constexpr int kEvents = 11;

//              started          arm              target or hand
//   Starting ───────────▶ Standby ───────▶ Armed ───────────────▶ Servoing ⇄ Holding
//                          ▲  ▲  ◀─disarm── │                      │ no target │
//                          │  └────disarm───┴──────────────────────┘           │
//                  reset   │  └────disarm, or held for too long────────────────┘
//   Stopped, Faulted ──────┘
//   any state ──e-stop, stop──▶ Stopped      any but Stopped ──bug──▶ Faulted
//   Armed, Servoing, Holding ──fault──▶ Faulted
//
// In Standby a fault of a drive or the bus bars arming, but is not latched: drives are often
// switched on after the daemon. Faulted gives way to Stopped, never the other way round.
constexpr State A = State::kStarting, B = State::kStandby, C = State::kArmed, D = State::kServoing,
                E = State::kHolding, S = State::kStopped, F = State::kFaulted;
constexpr State kNext[kStates][kEvents] = {
    //            estop stop bug fault disarm reset arm started expired motion no-motion
    /*Starting*/ {S, S, F, A, A, A, A, B, A, A, A},
    /*Standby*/ {S, S, F, B, B, B, C, B, B, B, B},
    /*Armed*/ {S, S, F, F, B, C, C, C, C, D, C},
    /*Servoing*/ {S, S, F, F, B, D, D, D, D, D, E},
    /*Holding*/ {S, S, F, F, B, E, E, E, B, D, E},
    /*Stopped*/ {S, S, S, S, S, B, S, S, S, S, S},
    /*Faulted*/ {S, S, F, F, F, B, F, F, F, F, F},
};

bool armed(State state) { return state == C || state == D || state == E; }

Cause estop_cause(const Inputs& in) {
  if (in.estop == Line::kActive) return Cause::kEstop;
  return in.estop == Line::kInactive ? Cause::kNone : Cause::kEstopUnknown;
}

Cause fault_cause(const Inputs& in) {
  if (in.drive_fault) return Cause::kDriveFault;
  if (!in.drives_alive) return Cause::kDrivesSilent;
  if (!in.bus_ok) return Cause::kBusDown;
  if (in.overruns) return Cause::kOverruns;
  return in.limits_exceeded ? Cause::kLimits : Cause::kNone;
}

bool hand(const SafetyConfig& config, const Inputs& in) {
  return in.manual_active && in.manual_age >= Duration(0) &&
         in.manual_age <= from_seconds(config.manual_age_s);
}

// Why the target must not be followed. Following begins with a lock; a short coasting, where the
// filter predicts across a few missing images, does not end it.
Cause target_cause(const SafetyConfig& config, State state, const Inputs& in) {
  const bool seen =
      in.track == TrackState::kLocked || (in.track == TrackState::kCoasting && state == D);
  if (!seen || !in.estimate_valid) return Cause::kTargetNone;
  if (in.estimate_age < Duration(0) || in.estimate_age > from_seconds(config.full_age_s)) {
    return Cause::kTargetOld;
  }
  // Written so that a NaN is uncertain.
  return in.estimate_sigma_m <= config.full_sigma_m ? Cause::kNone : Cause::kTargetUncertain;
}

Cause first(Cause a, Cause b) { return a != Cause::kNone ? a : b; }

// A person's hand needs no camera: a blind vehicle must still be brought home.
Cause arming_obstacle(const SafetyConfig& config, State state, const Inputs& in) {
  Cause cause = estop_cause(in);
  if (in.internal_fault) cause = first(cause, Cause::kInternalFault);
  if (state == S || state == F) cause = first(cause, Cause::kNotReset);
  // Also in Standby, which a reset reaches from a Stopped that came before every loop had run.
  if (state == A || !in.started) cause = first(cause, Cause::kNotStarted);
  if (!in.has_vehicle) cause = first(cause, Cause::kNoVehicle);
  if (!in.has_estop && !config.accept_no_estop) cause = first(cause, Cause::kNoEstop);
  cause = first(cause, fault_cause(in));
  if (!in.drives_ready) cause = first(cause, Cause::kDrivesNotReady);
  if (!in.drives_guarded) cause = first(cause, Cause::kDrivesUnguarded);
  if (!in.camera_alive && !hand(config, in)) cause = first(cause, Cause::kNoCamera);
  return cause;
}

Cause reset_obstacle(const Inputs& in) {
  return first(estop_cause(in), in.internal_fault ? Cause::kInternalFault : Cause::kNone);
}

std::array<Cause, kEvents> events(const SafetyConfig& config, const Memory& memory,
                                  const Inputs& in, TimePoint now, bool* happened) {
  const Cause obstacle = arming_obstacle(config, memory.state, in);
  const Cause target = target_cause(config, memory.state, in);
  const bool motion = target == Cause::kNone || hand(config, in);
  const bool expired = now - memory.since > from_seconds(config.hold_limit_s);
  std::array<Cause, kEvents> cause = {};
  const auto say = [&](Event event, bool is, Cause why) {
    happened[static_cast<int>(event)] = is;
    cause[static_cast<std::size_t>(event)] = why;
  };
  say(Event::kEstop, in.estop != Line::kInactive, estop_cause(in));
  say(Event::kStop, in.request == Request::kStop, Cause::kOperatorStop);
  say(Event::kBug, in.internal_fault, Cause::kInternalFault);
  say(Event::kFault, fault_cause(in) != Cause::kNone, fault_cause(in));
  say(Event::kDisarm, in.request == Request::kDisarm, Cause::kDisarmed);
  say(Event::kReset, in.request == Request::kReset && reset_obstacle(in) == Cause::kNone,
      Cause::kNone);
  say(Event::kArm, in.request == Request::kArm && obstacle == Cause::kNone, Cause::kNone);
  say(Event::kStarted, in.started, Cause::kNone);
  say(Event::kExpired, expired && !motion, Cause::kHoldExpired);
  say(Event::kMotion, motion, Cause::kNone);
  say(Event::kNoMotion, !motion, target);
  return cause;
}

Memory next(const SafetyConfig& config, const Memory& memory, const Inputs& in, TimePoint now) {
  bool happened[kEvents] = {};
  const auto cause = events(config, memory, in, now, happened);
  for (int e = 0; e < kEvents; ++e) {
    const State state = kNext[static_cast<int>(memory.state)][e];
    if (happened[e] && state != memory.state) {
      return {state, cause[static_cast<std::size_t>(e)], now};
    }
  }
  return memory;
}

Light light_of(State state) {
  switch (state) {
    case State::kStarting:
      return Light::kOff;
    case State::kStandby:
      return Light::kSlow;
    case State::kArmed:
    case State::kServoing:
    case State::kHolding:
      return Light::kOn;
    case State::kStopped:
    case State::kFaulted:
      return Light::kFast;
  }
  return Light::kFast;
}

Cause refusal(const SafetyConfig& config, State state, const Inputs& in) {
  if (in.request == Request::kArm && !armed(state)) return arming_obstacle(config, state, in);
  if (in.request == Request::kReset) return reset_obstacle(in);
  return Cause::kNone;
}

}  // namespace

const char* to_string(State state) { return kStateNames[static_cast<std::size_t>(state)]; }
const char* to_string(Cause cause) { return kCauseNames[static_cast<std::size_t>(cause)]; }

const char* to_string(Permit permit) {
  constexpr std::array<const char*, 3> kNames = {"none", "hold_only", "full"};
  return kNames[static_cast<std::size_t>(permit)];
}

const char* to_string(Light light) {
  constexpr std::array<const char*, 4> kNames = {"off", "slow", "on", "fast"};
  return kNames[static_cast<std::size_t>(light)];
}

Decision step(const SafetyConfig& config, const Memory& memory, const Inputs& inputs,
              TimePoint now) {
  Decision d;
  d.memory = next(config, memory, inputs, now);
  const State state = d.memory.state;
  Outputs& out = d.outputs;
  out.drive_enable = armed(state);
  out.permit = state == D ? Permit::kFull : out.drive_enable ? Permit::kHoldOnly : Permit::kNone;
  out.by_hand = state == D && hand(config, inputs);
  out.release_locked = state != D || out.by_hand;
  out.light = light_of(state);
  out.refused = refusal(config, memory.state, inputs);
  out.obstacle = arming_obstacle(config, state, inputs);
  out.cause = d.memory.cause;
  // What is being waited for says more here than how the state was reached.
  if (state == C || state == E) out.cause = target_cause(config, state, inputs);
  if (state == B) out.cause = first(out.obstacle, out.cause);
  return d;
}

}  // namespace gannet::safety
