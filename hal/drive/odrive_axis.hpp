// OdriveAxis: one axis of an ODrive as we see it over CANSimple: led into closed loop and out of
// it, watched, and its watchdog proven. Never blocks: what is due is written out in each cycle.
//
//   not enabled: idle is asked for, in each cycle at first, until a heartbeat newer than the first
//     request says it, then silence. Any frame to the axis
//     feeds its watchdog, so that only silence shows whether it expires. An axis that stays in
//     closed loop is stopped by Estop.
//   enabled: errors of the watchdog cleared, closed loop asked for until the axis says it, with
//     velocity control and speed 0 in each cycle; then a speed in each cycle.
//
// An error, or closed loop left or not reached, while enabled trips the axis: it is asked to idle
// and is faulty until enable has been taken away. Errors other than the watchdog's are cleared by a
// person's reset alone. Servo thread; RT safe after creation.
#pragma once

#include <optional>
#include <span>

#include "hal/drive/drive_values.hpp"
#include "hal/drive/odrive_config.hpp"
#include "hal/drive/odrive_messages.hpp"

namespace gannet::hal::odrive {

struct AxisSettings {
  int node = 1;
  double turns_per_rad = 0;     // with the sign: negative for a reversed motor
  double full_turns_per_s = 0;  // at setpoint 1, with the sign
  bool is_firmware_05 = false;
  std::uint32_t input_mode = kVelocityRamp;
  Duration feedback_timeout = {}, heartbeat_timeout = {}, guard_time = {};
};

enum class Trip : std::uint16_t { kNone = 0, kLeftClosedLoop = 0xF001, kDidNotEnable = 0xF002 };
enum class Guard : std::uint8_t { kUnknown, kProven, kMissing };

class OdriveAxis {
 public:
  static constexpr int kMaxFrames = 4;

  explicit OdriveAxis(const AxisSettings& settings);

  // A frame of this node. False: malformed. Commands of others are ignored.
  bool hear(const CanFrame& frame, TimePoint time);

  // Once a cycle: the frames that are due, at most kMaxFrames. No setpoint: speed 0.
  int speak(std::optional<double> setpoint, bool enable, TimePoint now, std::span<CanFrame> out);

  void reset_fault() { wants_reset_ = true; }

  int node() const { return settings_.node; }
  bool is_alive(TimePoint now) const;
  bool is_faulty() const { return trip_ != Trip::kNone || other_errors() != 0; }
  Guard guard() const { return guard_; }
  std::uint32_t error() const { return error_; }
  Trip trip() const { return trip_; }
  const char* trouble() const;  // of a faulty one; never null
  const DriveFeedback& feedback() const { return feedback_; }

 private:
  std::uint32_t watchdog_bit() const {
    return settings_.is_firmware_05 ? kWatchdog05 : kWatchdog06;
  }
  std::uint32_t other_errors() const { return error_ & ~watchdog_bit(); }
  void hear_heartbeat(const CanFrame& frame, TimePoint time);
  int stop(TimePoint now, std::span<CanFrame> out);
  int run(double turns_per_s, TimePoint now, std::span<CanFrame> out);
  void watch(bool enable, TimePoint now);
  void set_state(TimePoint now);

  const AxisSettings settings_;
  std::uint32_t error_ = 0, state_ = 0;
  bool has_heartbeat_ = false, has_estimates_ = false;
  TimePoint heartbeat_ = {}, absent_ = {};
  bool is_enabled_ = false, has_started_ = false, has_run_ = false;
  TimePoint since_ = {};  // enable was given or taken away
  TimePoint asked_ = {};  // for a state, last
  TimePoint spoken_ = {};
  bool wants_reset_ = false;
  Guard guard_ = Guard::kUnknown;
  Trip trip_ = Trip::kNone;
  DriveFeedback feedback_;
};

}  // namespace gannet::hal::odrive
