// OdriveDrive: motors behind ODrive controllers that speak CANSimple, each axis a node. A setpoint
// is the fraction −1 … 1 of drive.motor.full_speed_rad_s, by the vehicle's sign; NaN, or none, is
// speed 0.
//
// Out: see odrive_axis.hpp. In: heartbeats and encoder estimates, which must come by themselves (a
// motor is alive while both are fresh); currents, bus voltage and temperature where the drive sends
// them. In feedback a value not yet heard is NaN.
//
// The drive's own watchdog must stop the motor when we die: it has been seen to expire while we
// were silent, or arming is refused. Servo thread; RT safe after creation.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "hal/drive/drive.hpp"
#include "hal/drive/drive_config.hpp"
#include "hal/drive/odrive_axis.hpp"
#include "platform/base/result.hpp"

namespace gannet::hal {

class OdriveDrive final : public DriveGroup {
 public:
  // Error: what in the config does not fit together.
  static Result<std::unique_ptr<OdriveDrive>> create(const DriveConfig& config);

  int size() const override { return static_cast<int>(axes_.size()); }
  void receive(const CanFrame& frame, TimePoint time) override;
  int send(std::span<const DriveSetpoint> setpoints, bool enable, TimePoint now,
           std::span<CanFrame> out) override;
  int max_frames() const override { return odrive::OdriveAxis::kMaxFrames * size(); }
  std::span<const DriveFeedback> feedback() const override { return feedback_; }
  DriveGroupHealth health(TimePoint now) const override;
  std::uint64_t malformed() const override { return malformed_; }
  void reset_faults(TimePoint now) override;

  std::span<const odrive::OdriveAxis> axes() const { return axes_; }
  std::uint64_t bad_setpoints() const { return bad_setpoints_; }  // NaN or none, while enabled

  // What it listens to, for a bus's filters.
  static std::vector<CanFilter> wanted_frames(const DriveConfig& config);

 private:
  explicit OdriveDrive(const DriveConfig& config);

  const bool accepts_unguarded_;
  std::vector<odrive::OdriveAxis> axes_;
  std::array<std::int8_t, odrive::kMaxId + 1> axis_of_ = {};  // by node id; −1: nobody's
  std::vector<DriveFeedback> feedback_;
  std::uint64_t malformed_ = 0, bad_setpoints_ = 0;
};

}  // namespace gannet::hal
