#include "hal/drive/odrive_drive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace gannet::hal {

using namespace odrive;

namespace {

Result<void> check(const DriveConfig& config) {
  if (config.motors.empty()) return Error{"drive: no motor is configured; add [[drive.motor]]"};
  if (config.odrive.firmware != "0.5" && config.odrive.firmware != "0.6") {
    return Error{"drive.odrive.firmware must be 0.5 or 0.6"};
  }
  if (config.odrive.input_mode != "ramp" && config.odrive.input_mode != "direct") {
    return Error{"drive.odrive.input_mode '" + config.odrive.input_mode + "' is unknown"};
  }
  for (std::size_t i = 0; i < config.motors.size(); ++i) {
    const MotorConfig& motor = config.motors[i];
    const std::string name = "drive.motor " + std::to_string(i + 1) + ": ";
    const std::string id = std::to_string(motor.node_id);
    if (motor.node_id < 1 || motor.node_id > kMaxId) return Error{name + "node_id must be 1 to 63"};
    if (!(motor.full_speed_rad_s > 0)) return Error{name + "full_speed_rad_s must be above 0"};
    for (std::size_t other = 0; other < i; ++other) {
      if (config.motors[other].node_id != motor.node_id) continue;
      return Error{name + "node_id " + id + " is also that of motor " + std::to_string(other + 1) +
                   "; each axis has its own"};
    }
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<OdriveDrive>> OdriveDrive::create(const DriveConfig& config) {
  if (auto good = check(config); !good) return good.error();
  return std::unique_ptr<OdriveDrive>(new OdriveDrive(config));
}

OdriveDrive::OdriveDrive(const DriveConfig& config)
    : accepts_unguarded_(config.odrive.accept_unguarded), feedback_(config.motors.size()) {
  axis_of_.fill(-1);
  axes_.reserve(config.motors.size());
  for (const MotorConfig& motor : config.motors) {
    const double turns_per_rad = (motor.reversed ? -1 : 1) / (2 * std::numbers::pi);
    axis_of_[static_cast<std::size_t>(motor.node_id)] = static_cast<std::int8_t>(axes_.size());
    axes_.emplace_back(AxisSettings{
        .node = motor.node_id,
        .turns_per_rad = turns_per_rad,
        .full_turns_per_s = turns_per_rad * motor.full_speed_rad_s * motor.max_command,
        .is_firmware_05 = config.odrive.firmware == "0.5",
        .input_mode = config.odrive.input_mode == "ramp" ? kVelocityRamp : kPassthrough,
        .feedback_timeout = from_seconds(config.feedback_timeout_s),
        .heartbeat_timeout = from_seconds(config.odrive.heartbeat_timeout_s),
        .guard_time = from_seconds(config.odrive.guard_time_s)});
  }
  for (std::size_t i = 0; i < axes_.size(); ++i) feedback_[i] = axes_[i].feedback();
}

std::vector<CanFilter> OdriveDrive::wanted_frames(const DriveConfig& config) {
  std::vector<CanFilter> filters;
  for (const MotorConfig& motor : config.motors) {
    for (const MessageAbout& message : kMessages) {
      if (!message.from_drive) continue;
      filters.push_back({.id = id_of(message.command, motor.node_id), .mask = kMaxStandardId});
    }
  }
  return filters;
}

void OdriveDrive::receive(const CanFrame& frame, TimePoint time) {
  if (frame.extended || frame.error || frame.id > kMaxStandardId) return;
  const int axis = axis_of_[frame.id >> 5];
  if (axis < 0) return;
  if (!axes_[static_cast<std::size_t>(axis)].hear(frame, time)) ++malformed_;
}

int OdriveDrive::send(std::span<const DriveSetpoint> setpoints, bool enable, TimePoint now,
                      std::span<CanFrame> out) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const bool is_good = i < setpoints.size() && !std::isnan(setpoints[i].value);
    if (enable && !is_good) ++bad_setpoints_;
    std::optional<double> setpoint;
    if (is_good) setpoint = std::clamp(setpoints[i].value, -1.0, 1.0);
    n += static_cast<std::size_t>(axes_[i].speak(setpoint, enable, now, out.subspan(n)));
    feedback_[i] = axes_[i].feedback();
  }
  return static_cast<int>(n);
}

void OdriveDrive::reset_faults(TimePoint) {
  for (OdriveAxis& axis : axes_) axis.reset_fault();
}

DriveGroupHealth OdriveDrive::health(TimePoint now) const {
  DriveGroupHealth health = {.all_alive = true};
  for (int i = 0; i < size(); ++i) {
    const OdriveAxis& axis = axes_[static_cast<std::size_t>(i)];
    const bool alive = axis.is_alive(now), faulty = axis.is_faulty();
    const bool is_missing = axis.guard() == Guard::kMissing;
    const bool ready = alive && (accepts_unguarded_ || axis.guard() != Guard::kUnknown);
    const bool guarded = accepts_unguarded_ || !is_missing;
    health.all_alive = health.all_alive && alive;
    health.any_fault = health.any_fault || faulty;
    health.all_ready = health.all_ready && ready;
    health.guards_itself = health.guards_itself && guarded;
    if (health.first_bad >= 0 || (alive && !faulty && ready && guarded)) continue;
    health.first_bad = i;
    if (faulty) {
      health.trouble = axis.trouble();
      health.trouble_code = axis.error() != 0 ? axis.error() : axis.feedback().fault_code;
    } else if (alive) {
      health.trouble = is_missing ? "its watchdog does not expire"
                                  : "its watchdog has not yet been seen to expire";
    }
  }
  return health;
}

}  // namespace gannet::hal
