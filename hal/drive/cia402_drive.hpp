// Cia402Drive: motors behind CiA 402 drives on CANopen, one drive a node. A setpoint is the
// fraction −1 … 1 of the motor's full_speed_rad_s, by the vehicle's sign; NaN, or none, halts.
//
// Out, in each call of send: control word and target velocity to every drive that runs, then SYNC,
// upon which the drives take their targets and tell status word, velocity and current; our
// heartbeat, which the drives watch; NMT and SDO of the set-up. While not enabled every drive is
// led to a stop and off.
// In: heartbeats, SDO answers, EMCY, and the drives' PDOs.
//
// A drive is set up when it appears, and again when it restarts. One that restarts, falls silent,
// faults or disables itself while enabled is a fault of the group, until enable has been taken
// away; see cia402_axis.hpp. So is another master that sends SYNC or heartbeats under our
// node id, until 2 s after the last: the drives would not miss us. Servo thread; RT safe after
// creation.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "hal/drive/cia402_axis.hpp"
#include "hal/drive/drive.hpp"
#include "hal/drive/drive_config.hpp"
#include "platform/base/result.hpp"

namespace gannet::hal {

struct Cia402Counters {
  std::uint64_t own_id_conflicts = 0;  // heartbeats under our node id, or SYNC, of somebody else
  std::uint64_t bad_setpoints = 0;     // NaN, or none for a motor, while enabled
};

class Cia402Drive final : public DriveGroup {
 public:
  // Error: what in the config does not fit together.
  static Result<std::unique_ptr<Cia402Drive>> create(const DriveConfig& config);

  int size() const override { return static_cast<int>(axes_.size()); }
  void receive(const CanFrame& frame, TimePoint time) override;
  int send(std::span<const DriveSetpoint> setpoints, bool enable, TimePoint now,
           std::span<CanFrame> out) override;
  int max_frames() const override { return 2 + cia402::Cia402Axis::kMaxFrames * size(); }
  std::span<const DriveFeedback> feedback() const override { return feedback_; }
  DriveGroupHealth health(TimePoint now) const override;
  std::uint64_t malformed() const override { return malformed_; }
  void reset_faults(TimePoint now) override;

  // For status and diagnosis, on the same thread.
  std::span<const cia402::Cia402Axis> axes() const { return axes_; }
  const Cia402Counters& counters() const { return counters_; }

  // What it listens to, for a bus's filters.
  static std::vector<CanFilter> wanted_frames(const DriveConfig& config);

 private:
  explicit Cia402Drive(const DriveConfig& config);
  bool is_in_conflict(TimePoint now) const;
  bool hear(cia402::Cia402Axis& axis, std::uint32_t base, const CanFrame& frame, TimePoint time);

  const Cia402Config config_;
  const int own_id_;
  std::vector<cia402::Cia402Axis> axes_;
  std::array<std::int8_t, canopen::kMaxNodeId + 1> axis_of_ = {};  // by node id; −1: nobody's
  std::vector<DriveFeedback> feedback_;
  TimePoint next_heartbeat_ = {};
  bool has_started_ = false;
  TimePoint conflict_ = {};  // the last
  Cia402Counters counters_;
  std::uint64_t malformed_ = 0;
};

}  // namespace gannet::hal
