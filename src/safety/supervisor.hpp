// Supervisor: what may move. A pure function of its memory, this cycle's inputs and the time; it
// knows no line, bus, camera or thread. It never arms itself: only a person's request leads to
// Armed, and a restarted daemon begins at Starting and waits in Standby. The path from the e-stop
// line to the permit uses no estimate and no configuration.
// Called once a cycle, before the permit gate. Servo thread; RT safe.
#pragma once

#include <array>
#include <cstdint>

#include "platform/base/time.hpp"
#include "src/core/permit.hpp"
#include "src/core/pose_estimate.hpp"
#include "src/safety/safety_config.hpp"

namespace gannet::safety {

enum class State : std::uint8_t {
  kStarting,
  kStandby,
  kArmed,
  kServoing,
  kHolding,
  kStopped,
  kFaulted
};
inline constexpr int kStates = 7;

// The e-stop line. A reading whose edge says that it was pressed and released between two cycles
// is kActive too: the caller merges level and edges.
enum class Line : std::uint8_t { kInactive, kActive, kUnknown };

enum class Request : std::uint8_t { kNone, kArm, kDisarm, kReset, kStop };

enum class Cause : std::uint8_t {
  kNone,
  kEstop,          // the line is active
  kEstopUnknown,   // the line cannot be read
  kOperatorStop,   // a person asked for stop
  kInternalFault,  // a bug of ours was caught
  kDriveFault,     // a drive reports a fault
  kDrivesSilent,   // a drive was not heard within its time
  kBusDown,
  kOverruns,         // too many missed periods
  kLimits,           // a motor was too hot, or drew too much, for too long
  kNotStarted,       // arm: still starting
  kNotReset,         // arm: stopped or faulted, a reset is needed first
  kNoVehicle,        // arm: vehicle.kind is "none"
  kNoCamera,         // the cameras are silent
  kTargetNone,       // no estimate, searching or lost
  kTargetOld,        // the newest estimate is too old
  kTargetUncertain,  // its position's standard deviation is too large
  kHoldExpired,      // held for too long without a target
  kDisarmed,         // a person asked for it
  kDrivesNotReady,   // arm: a drive is not set up yet, or refused it
  kDrivesUnguarded,  // arm: a drive would run on when we fall silent
  kNoEstop,          // arm: there is no e-stop line, and the config does not accept that
};
inline constexpr int kCauses = 22;

enum class Light : std::uint8_t { kOff, kSlow, kOn, kFast };  // blinking 1 Hz, 5 Hz

const char* to_string(State state);    // "standby" …
const char* to_string(Cause cause);    // "estop" …
const char* to_string(Permit permit);  // "none" "hold_only" "full"
const char* to_string(Light light);

// One cycle's facts. The defaults are the bad ones: what is not filled in stops.
struct Inputs {
  bool started = false;  // every device is open, every loop has run
  Line estop = Line::kUnknown;
  bool has_estop = false;            // there is a line; bars arming only
  Request request = Request::kNone;  // of this cycle only
  bool has_vehicle = false;          // vehicle.kind is not "none"
  bool internal_fault = false;
  bool drive_fault = true;
  bool drives_alive = false;
  bool drives_ready = false;    // set up; bars arming only
  bool drives_guarded = false;  // stop by themselves when we fall silent; bars arming only
  bool bus_ok = false;
  bool overruns = false;         // OverrunWatch says too many
  bool limits_exceeded = false;  // LimitWatch says for too long
  bool camera_alive = false;
  bool manual_active = false;                 // a person's hand commands a velocity …
  Duration manual_age = {};                   // … this long ago
  TrackState track = TrackState::kSearching;  // of the newest estimate
  Duration estimate_age = {};   // now − capture of the newest measurement in the filter
  double estimate_sigma_m = 0;  // largest standard deviation of the position
  bool estimate_valid = false;  // the filter has a prediction
};

// What the supervisor remembers; a value-initialised one is a fresh start.
struct Memory {
  State state = State::kStarting;
  Cause cause = Cause::kNone;  // why it is in this state; latched in Stopped and Faulted
  TimePoint since = {};        // when the state was entered
};

struct Outputs {
  Permit permit = Permit::kNone;
  bool drive_enable = false;
  bool by_hand = false;        // full permit, but for the person's wish, not for the law
  bool release_locked = true;  // the release line must not fire
  Light light = Light::kOff;
  Cause cause = Cause::kNone;     // why the permit is not full; kNone when it is
  Cause refused = Cause::kNone;   // why this cycle's arm or reset was refused
  Cause obstacle = Cause::kNone;  // what would refuse an arm request now; kNone: ready
};

struct Decision {
  Memory memory;
  Outputs outputs;
};

Decision step(const SafetyConfig& config, const Memory& memory, const Inputs& inputs,
              TimePoint now);

}  // namespace gannet::safety
