// VescDrive: motors behind VESC controllers that speak VESC's own CAN protocol. A setpoint is the
// fraction −1 … 1 of the motor's full scale by drive.vesc.mode, by the vehicle's sign; NaN, or
// none, stops.
//
// Out: while enabled a command to each VESC in each call of send (or as command_period_s says);
// after that the stop, in each call, for stop_time_s, then silence: the VESC's own time-out must
// pass, which is asked of it, so that it is known and not believed that a VESC stops when we die.
// One that is not alive is told to stop until it has been back for stop_time_s: a bus that returns
// may bring it old commands first, from a queue. One that does not time out within guard_time_s is
// not guarded, or hears other commands than ours. Each VESC is asked for its fault and its time-out
// ten times a second.
//
// In: STATUS 1, 4 and 5, and the answers. A motor is alive while STATUS 1 and, once it has come,
// the answer about its fault are fresh; without that answer it is not ready. In feedback a value
// not yet heard is NaN. Servo thread; RT safe after creation.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "hal/drive/drive.hpp"
#include "hal/drive/drive_config.hpp"
#include "hal/drive/vesc_messages.hpp"
#include "platform/base/result.hpp"

namespace gannet::hal {

class VescDrive final : public DriveGroup {
 public:
  // Error: what in the config does not fit together.
  static Result<std::unique_ptr<VescDrive>> create(const DriveConfig& config);

  int size() const override { return static_cast<int>(axes_.size()); }
  void receive(const CanFrame& frame, TimePoint time) override;
  int send(std::span<const DriveSetpoint> setpoints, bool enable, TimePoint now,
           std::span<CanFrame> out) override;
  int max_frames() const override { return 2 * size(); }
  std::span<const DriveFeedback> feedback() const override { return feedback_; }
  DriveGroupHealth health(TimePoint now) const override;
  std::uint64_t malformed() const override { return malformed_; }

  std::uint64_t bad_setpoints() const { return bad_setpoints_; }  // NaN or none, while enabled

  // What it listens to, for a bus's filters.
  static std::vector<CanFilter> wanted_frames(const DriveConfig& config);

 private:
  enum class Guard : std::uint8_t { kUnknown, kProven, kMissing };
  struct Axis {
    int node = 1;
    double sign = 1;            // of its turning
    double full = 0;            // what a setpoint of 1 commands, with the sign
    double rad_s_per_erpm = 0;  // with the sign
    bool was_heard = false;
    bool tells_fault = false;  // it has done so
    TimePoint told = {};       // its fault, last
    Guard guard = Guard::kUnknown;
    bool asks_for_timeout = false;  // turn by turn with the fault
    TimePoint next_question = {};
    TimePoint absent = {};     // when it was so last
    TimePoint commanded = {};  // last
  };

  explicit VescDrive(const DriveConfig& config);
  bool take_answer(const CanFrame& frame, TimePoint time);
  CanFrame command(const Axis& axis, std::optional<double> setpoint) const;
  bool is_command_due(bool enable, TimePoint now);
  bool is_silent(const Axis& axis, TimePoint now) const;
  bool is_alive(std::size_t i, TimePoint now) const;
  bool is_guarded(const Axis& axis) const;
  const char* trouble(std::size_t i, TimePoint now) const;
  void watch(TimePoint now);
  void set_states(TimePoint now);

  const VescConfig config_;
  const int own_id_;
  const Duration feedback_timeout_, command_period_, stop_time_;
  vesc::Command mode_;
  std::vector<Axis> axes_;
  std::array<std::int16_t, 256> axis_of_ = {};  // by id; −1: nobody's
  std::vector<DriveFeedback> feedback_;
  bool is_enabled_ = false, has_started_ = false;
  TimePoint disabled_ = {}, last_command_ = {};
  std::uint64_t malformed_ = 0, bad_setpoints_ = 0;
};

}  // namespace gannet::hal
