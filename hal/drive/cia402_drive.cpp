#include "hal/drive/cia402_drive.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace gannet::hal {

using canopen::kEmcyBase;
using canopen::kHeartbeatBase;
using canopen::kMaxNodeId;
using canopen::kSdoAnswerBase;
using cia402::Cia402Axis;

namespace {

constexpr Duration kConflictTime = std::chrono::seconds(2);  // beyond any heartbeat's period

void tell_trouble(const Cia402Axis& axis, DriveGroupHealth& health) {
  const cia402::Refusal& refusal = axis.refusal();
  if (axis.is_faulty()) {
    health.trouble_code = axis.fault_code();
    health.trouble = canopen::words_of_emergency(axis.fault_code());
  } else if (refusal.object.index != 0) {
    health.trouble_code =
        static_cast<std::uint32_t>(refusal.object.index) << 8 | refusal.object.sub;
    health.trouble = refusal.abort_code != 0 ? canopen::words_of_abort(refusal.abort_code)
                                             : "an object has not the value that is wanted";
  }
}

Result<void> check_times(const Cia402Config& c) {
  const std::string group = "drive.cia402.";
  if (c.guard_time_s < 2 * c.heartbeat_period_s) {
    return Error{group + "guard_time_s must be at least twice heartbeat_period_s"};
  }
  if (c.heartbeat_period_s < c.servo_period_s) {
    return Error{group + "heartbeat_period_s is shorter than a servo cycle"};
  }
  if (c.node_timeout_s < 2 * c.node_heartbeat_s) {
    return Error{group + "node_timeout_s must be at least twice node_heartbeat_s"};
  }
  if (c.pdo < 1 || c.pdo > 4) return Error{group + "pdo must be 1 to 4"};
  if (!(velocity_units_per_rad_s(c) > 0)) {
    return Error{group + "velocity_unit '" + c.velocity_unit + "' is unknown"};
  }
  return {};
}

Result<void> check(const DriveConfig& config) {
  if (config.motors.empty()) return Error{"drive: no motor is configured; add [[drive.motor]]"};
  if (config.own_node_id < 1 || config.own_node_id > kMaxNodeId) {
    return Error{"drive.own_node_id must be 1 to 127"};
  }
  for (std::size_t i = 0; i < config.motors.size(); ++i) {
    const MotorConfig& motor = config.motors[i];
    const std::string name = "drive.motor " + std::to_string(i + 1) + ": ";
    const std::string id = std::to_string(motor.node_id);
    if (motor.node_id < 1 || motor.node_id > kMaxNodeId) {
      return Error{name + "node_id must be 1 to 127"};
    }
    if (motor.node_id == config.own_node_id) {
      return Error{name + "node_id " + id + " is drive.own_node_id"};
    }
    for (std::size_t other = 0; other < i; ++other) {
      if (config.motors[other].node_id != motor.node_id) continue;
      return Error{name + "node_id " + id + " is also that of motor " + std::to_string(other + 1) +
                   "; a CiA 402 node drives one motor"};
    }
    const double units = motor.full_speed_rad_s * velocity_units_per_rad_s(config.cia402);
    if (!(units >= 1 && units <= 2147483647.0)) {
      return Error{name + "full_speed_rad_s is " + std::to_string(units) +
                   " in the drive's velocity unit; it must be 1 to 2147483647"};
    }
  }
  return check_times(config.cia402);
}

}  // namespace

Result<std::unique_ptr<Cia402Drive>> Cia402Drive::create(const DriveConfig& config) {
  if (auto good = check(config); !good) return good.error();
  return std::unique_ptr<Cia402Drive>(new Cia402Drive(config));
}

Cia402Drive::Cia402Drive(const DriveConfig& config)
    : config_(config.cia402), own_id_(config.own_node_id), feedback_(config.motors.size()) {
  axis_of_.fill(-1);
  axes_.reserve(config.motors.size());
  for (const MotorConfig& motor : config.motors) {
    const double sign = motor.reversed ? -1 : 1;
    const double units = velocity_units_per_rad_s(config_) * sign;
    axis_of_[static_cast<std::size_t>(motor.node_id)] = static_cast<std::int8_t>(axes_.size());
    axes_.emplace_back(
        cia402::AxisSettings{.node = motor.node_id,
                             .own_node = own_id_,
                             .units_per_rad_s = units,
                             .full_units = units * motor.full_speed_rad_s * motor.max_command,
                             .increments_per_rad = position_units_per_rad(config_) * sign,
                             .feedback_timeout = from_seconds(config.feedback_timeout_s)},
        config_);
  }
}

std::vector<CanFilter> Cia402Drive::wanted_frames(const DriveConfig& config) {
  std::vector<CanFilter> filters;
  const auto add = [&](std::uint32_t base, int node) {
    filters.push_back({.id = base + static_cast<std::uint32_t>(node), .mask = kMaxStandardId});
  };
  for (const MotorConfig& motor : config.motors) {
    for (const std::uint32_t base :
         {kEmcyBase, canopen::tpdo_base(config.cia402.pdo), kSdoAnswerBase, kHeartbeatBase}) {
      add(base, motor.node_id);
    }
    if (config.cia402.report_position)
      add(canopen::tpdo_base(position_pdo(config.cia402)), motor.node_id);
  }
  add(kHeartbeatBase, config.own_node_id);
  add(canopen::sync_frame().id, 0);
  return filters;
}

// ---- frames in ----------------------------------------------------------------------------------

void Cia402Drive::receive(const CanFrame& frame, TimePoint time) {
  if (frame.extended || frame.error || frame.id > kMaxStandardId) return;
  const std::uint32_t node = frame.id & 0x7F, base = frame.id & 0x780;
  const bool is_sync = frame.id == canopen::sync_frame().id;
  if (is_sync || (base == kHeartbeatBase && static_cast<int>(node) == own_id_)) {
    ++counters_.own_id_conflicts;
    conflict_ = time;
    return;
  }
  const int axis = axis_of_[node];
  if (axis < 0) return;
  if (frame.length > frame.data.size() ||
      !hear(axes_[static_cast<std::size_t>(axis)], base, frame, time)) {
    ++malformed_;
  }
}

bool Cia402Drive::hear(Cia402Axis& axis, std::uint32_t base, const CanFrame& frame,
                       TimePoint time) {
  if (base == kHeartbeatBase) return axis.hear_heartbeat(frame, time);
  if (base == kEmcyBase) return axis.hear_emergency(frame, time);
  if (base == kSdoAnswerBase) return axis.hear_answer(frame, time);
  if (base == canopen::tpdo_base(config_.pdo)) return axis.hear_pdo(frame, time);
  if (config_.report_position && base == canopen::tpdo_base(position_pdo(config_)))
    return axis.hear_position(frame);
  return true;
}

// ---- frames out ---------------------------------------------------------------------------------

int Cia402Drive::send(std::span<const DriveSetpoint> setpoints, bool enable, TimePoint now,
                      std::span<CanFrame> out) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const bool is_good = i < setpoints.size() && !std::isnan(setpoints[i].value);
    if (enable && !is_good) ++counters_.bad_setpoints;
    std::optional<double> setpoint;
    if (is_good) setpoint = std::clamp(setpoints[i].value, -1.0, 1.0);
    if (const auto frame = axes_[i].command(setpoint, enable, now)) out[n++] = *frame;
  }
  out[n++] = canopen::sync_frame();
  if (!has_started_ || now >= next_heartbeat_) {
    // On its own raster, so that a cycle's jitter does not add up; a missed turn is skipped.
    const Duration period = from_seconds(config_.heartbeat_period_s);
    const bool is_late = !has_started_ || now - next_heartbeat_ >= period;
    next_heartbeat_ = is_late ? now + period : next_heartbeat_ + period;
    has_started_ = true;
    out[n++] = canopen::heartbeat_frame(own_id_, canopen::NmtState::kOperational);
  }
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    n += static_cast<std::size_t>(axes_[i].manage(now, out.subspan(n)));
    feedback_[i] = axes_[i].feedback();
  }
  return static_cast<int>(n);
}

void Cia402Drive::reset_faults(TimePoint now) {
  for (Cia402Axis& axis : axes_) axis.reset_fault(now);
}

// ---- health -------------------------------------------------------------------------------------

bool Cia402Drive::is_in_conflict(TimePoint now) const {
  return counters_.own_id_conflicts > 0 && now - conflict_ <= kConflictTime;
}

DriveGroupHealth Cia402Drive::health(TimePoint now) const {
  DriveGroupHealth health = {.all_alive = true};
  if (is_in_conflict(now)) {
    health.any_fault = true;
    health.guards_itself = false;
    health.first_bad = 0;
    health.trouble = "another master on the bus speaks as we do";
    health.trouble_code = static_cast<std::uint32_t>(own_id_);
  }
  for (int i = 0; i < size(); ++i) {
    const Cia402Axis& axis = axes_[static_cast<std::size_t>(i)];
    const bool alive = axis.is_alive(now), faulty = axis.is_faulty(), ready = axis.is_ready(now);
    // Whether it guards itself is known once it has been set up.
    const bool guarded = axis.guards_itself() || config_.accept_unguarded || !ready;
    health.all_alive = health.all_alive && alive;
    health.any_fault = health.any_fault || faulty;
    health.all_ready = health.all_ready && ready;
    health.guards_itself = health.guards_itself && guarded;
    if (health.first_bad >= 0 || (alive && !faulty && ready && guarded)) continue;
    health.first_bad = i;
    tell_trouble(axis, health);
  }
  return health;
}

}  // namespace gannet::hal
