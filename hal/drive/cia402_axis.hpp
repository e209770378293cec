// Cia402Axis: one CiA 402 drive as its master sees it: found, set up by SDO, started, watched, and
// led through its state machine. Never blocks: what is due is written out in each cycle.
//
//   kAbsent ──anything heard, or time to ask──▶ kSettingUp ──all steps──▶ kStarting ─operational─▶
//   kRunning
//      ▲  ◀── no answer ──────────────────────────┤                          │ │ │ └─a step
//      failed─▶ kRefused ┴── boot-up, heartbeat lost, └─────────────────────────────────────────
//      after a second ───┘            not operational ─▶ kAbsent
//
// What goes wrong while the motor is enabled trips the axis: it stops, reports a fault, and stays
// so until enable has been taken away; it never enables itself again. Servo thread; RT safe after
// creation.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "hal/drive/canopen_frames.hpp"
#include "hal/drive/cia402_setup.hpp"
#include "hal/drive/cia402_state.hpp"
#include "hal/drive/drive_values.hpp"

namespace gannet::hal::cia402 {

enum class AxisPhase : std::uint8_t { kAbsent, kSettingUp, kStarting, kRunning, kRefused };

// Why an axis tripped, with what drives' EMCY would say.
enum class Trip : std::uint16_t {
  kNone = 0,
  kRestarted = 0x6010,       // boot-up
  kLost = 0x8130,            // no heartbeat
  kNotOperational = 0x8100,  // the drive left NMT operational, or was never there
  kLeftOperation = 0xF001,   // disabled by itself
  kDidNotEnable = 0xF002,
  kFault = 0xFF00,  // its status word says so; the EMCY's code stands before this one
};

// Which step of the set-up a drive did not pass; zero: none.
struct Refusal {
  ObjectId object;
  std::uint32_t abort_code = 0;  // 0: the value read is not the one wanted
  std::uint32_t value = 0;       // as read
};

struct AxisSettings {
  int node = 1;
  int own_node = 10;
  double units_per_rad_s = 1;     // with the sign: negative for a reversed motor
  double full_units = 0;          // target at setpoint 1
  double increments_per_rad = 1;  // with the sign too
  Duration feedback_timeout = {};
};

class Cia402Axis {
 public:
  static constexpr int kMaxFrames = 3;  // setpoint; then NMT and SDO

  Cia402Axis(const AxisSettings& settings, const Cia402Config& config);

  // Frames of this node, by what they are. False: malformed.
  bool hear_heartbeat(const CanFrame& frame, TimePoint time);
  bool hear_emergency(const CanFrame& frame, TimePoint time);
  bool hear_answer(const CanFrame& frame, TimePoint time);
  bool hear_pdo(const CanFrame& frame, TimePoint time);
  bool hear_position(const CanFrame& frame);

  // Once a cycle: the setpoint's frame, if the drive listens. No setpoint: halt.
  std::optional<CanFrame> command(std::optional<double> setpoint, bool enable, TimePoint now);
  // Then: NMT and SDO frames that are due; returns how many, at most 2.
  int manage(TimePoint now, std::span<CanFrame> out);

  // Leads out of a fault, by a communication reset where the fault is one of communication.
  void reset_fault(TimePoint now);

  int node() const { return settings_.node; }
  AxisPhase phase() const { return phase_; }
  State state() const { return state_; }
  Trip trip() const { return trip_; }
  Refusal refusal() const { return refusal_; }
  bool guards_itself() const { return (watches_us_ && reacts_) || watches_setpoints_; }
  bool is_alive(TimePoint now) const;  // heard lately
  bool is_ready(TimePoint now) const;  // may be enabled, but for a fault
  bool is_faulty() const;
  std::uint16_t fault_code() const;  // of the EMCY or the trip; 0: not faulty
  const canopen::Emergency& emergency() const { return emergency_; }
  const DriveFeedback& feedback() const { return feedback_; }

 private:
  void enter(AxisPhase phase, TimePoint now);
  void begin_setup(TimePoint now);
  void next_step(TimePoint now);
  void judge_step(TimePoint now);
  void learn(const SetupStep& step, std::optional<std::uint32_t> value);
  void refuse(const SetupStep& step, TimePoint now);
  void lose(Trip why, TimePoint now);
  void watch(TimePoint now);
  void trip_if_enabled(Trip why);
  Goal goal(bool has_setpoint, bool enable, TimePoint now);
  std::optional<Goal> reset_goal(TimePoint now);
  void ask_for_code();
  void set_state(TimePoint now);

  const AxisSettings settings_;
  const Cia402Config config_;
  const std::vector<SetupStep> steps_;
  canopen::SdoClient sdo_;

  AxisPhase phase_ = AxisPhase::kAbsent;
  TimePoint phase_since_ = {};
  bool has_begun_ = false;
  std::size_t step_ = 0;
  std::optional<TimePoint> step_since_;     // of a step that is asked again
  std::optional<canopen::NmtCommand> nmt_;  // to be sent
  TimePoint start_sent_ = {};
  bool watches_us_ = false, reacts_ = false, watches_setpoints_ = false;
  double rated_current_a_ = 0;
  Refusal refusal_;

  TimePoint heard_ = {}, heartbeat_ = {};
  bool was_heard_ = false, has_status_ = false;
  int since_position_ = 0;  // status PDOs since the newest position
  State state_ = State::kUnknown;
  canopen::Emergency emergency_;
  bool asks_for_code_ = false;

  bool is_enabled_ = false, has_run_ = false;
  TimePoint enabled_since_ = {};
  std::optional<TimePoint> stop_since_, reset_since_, pulse_since_;
  bool has_reset_communication_ = false;
  Trip trip_ = Trip::kNone;
  DriveFeedback feedback_;
};

}  // namespace gannet::hal::cia402
