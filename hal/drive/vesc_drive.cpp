#include "hal/drive/vesc_drive.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace gannet::hal {

using namespace vesc;

namespace {

constexpr Duration kQuestionPeriod = std::chrono::milliseconds(50);  // fault and time-out in turn
constexpr Duration kQuestionStep = std::chrono::milliseconds(5);     // not all in one cycle
constexpr Duration kAnswerAge = std::chrono::seconds(1);             // ten answers lost in a row
constexpr double kRadPerSPerRpm = 2 * std::numbers::pi / 60;
constexpr double kKelvinAt0C = 273.15;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::optional<Command> mode_named(const std::string& name) {
  if (name == "duty") return kSetDuty;
  if (name == "speed") return kSetRpm;
  if (name == "current") return kSetCurrent;
  return {};
}

const Signal& signal_of(Command mode) {
  return mode == kSetDuty ? kDuty : mode == kSetRpm ? kErpm : kCurrent;
}

Result<void> check(const DriveConfig& config) {
  if (config.motors.empty()) return Error{"drive: no motor is configured; add [[drive.motor]]"};
  if (config.own_node_id < 1 || config.own_node_id > kMaxId) {
    return Error{"drive.own_node_id must be 1 to 127"};
  }
  if (!mode_named(config.vesc.mode)) {
    return Error{"drive.vesc.mode '" + config.vesc.mode + "' is unknown"};
  }
  for (std::size_t i = 0; i < config.motors.size(); ++i) {
    const MotorConfig& motor = config.motors[i];
    const std::string name = "drive.motor " + std::to_string(i + 1) + ": ";
    const std::string id = std::to_string(motor.node_id);
    if (motor.node_id < 1 || motor.node_id > kMaxId)
      return Error{name + "node_id must be 1 to 127"};
    if (motor.node_id == config.own_node_id) {
      return Error{name + "node_id " + id + " is drive.own_node_id"};
    }
    if (motor.pole_pairs < 1) return Error{name + "pole_pairs must be at least 1"};
    for (std::size_t other = 0; other < i; ++other) {
      if (config.motors[other].node_id != motor.node_id) continue;
      return Error{name + "node_id " + id + " is also that of motor " + std::to_string(other + 1) +
                   "; each side of a double VESC has its own"};
    }
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<VescDrive>> VescDrive::create(const DriveConfig& config) {
  if (auto good = check(config); !good) return good.error();
  return std::unique_ptr<VescDrive>(new VescDrive(config));
}

VescDrive::VescDrive(const DriveConfig& config)
    : config_(config.vesc),
      own_id_(config.own_node_id),
      feedback_timeout_(from_seconds(config.feedback_timeout_s)),
      command_period_(from_seconds(config.command_period_s)),
      // No shorter than an absence may go unseen: else one could be left alone while it is away.
      stop_time_(std::max(from_seconds(config.vesc.stop_time_s), feedback_timeout_)),
      mode_(*mode_named(config.vesc.mode)),
      feedback_(config.motors.size(),
                {.current_a = kNan, .voltage_v = kNan, .temperature_k = kNan}) {
  axis_of_.fill(-1);
  for (const MotorConfig& motor : config.motors) {
    Axis axis = {.node = motor.node_id, .sign = motor.reversed ? -1.0 : 1.0};
    axis.rad_s_per_erpm = axis.sign * kRadPerSPerRpm / motor.pole_pairs;
    axis.full = mode_ == kSetDuty      ? axis.sign * config_.full_duty
                : mode_ == kSetCurrent ? axis.sign * config_.full_current_a
                                       : motor.full_speed_rad_s / axis.rad_s_per_erpm;
    axis.full *= motor.max_command;
    axis_of_[static_cast<std::size_t>(motor.node_id)] = static_cast<std::int16_t>(axes_.size());
    axes_.push_back(axis);
  }
}

std::vector<CanFilter> VescDrive::wanted_frames(const DriveConfig& config) {
  std::vector<CanFilter> filters;
  const auto add = [&](Command command, int node) {
    filters.push_back({.id = id_of(command, node), .mask = kMaxExtendedId, .extended = true});
  };
  for (const MotorConfig& motor : config.motors) {
    for (const Command status : {kStatus1Id, kStatus4Id, kStatus5Id}) add(status, motor.node_id);
  }
  add(kShortPacket, config.own_node_id);
  return filters;
}

// ---- frames in ----------------------------------------------------------------------------------

void VescDrive::receive(const CanFrame& frame, TimePoint time) {
  if (!frame.extended || frame.error || frame.id > 0xFFFF) return;
  const std::uint32_t command = frame.id >> 8, node = frame.id & 0xFF;
  if (command == kShortPacket) {
    if (static_cast<int>(node) == own_id_ && !take_answer(frame, time)) ++malformed_;
    return;
  }
  const int i = axis_of_[node];
  const bool is_status = command == kStatus1Id || command == kStatus4Id || command == kStatus5Id;
  if (i < 0 || !is_status) return;
  if (frame.length < least_length(command) || frame.length > frame.data.size()) {
    ++malformed_;
    return;
  }
  Axis& axis = axes_[static_cast<std::size_t>(i)];
  DriveFeedback& feedback = feedback_[static_cast<std::size_t>(i)];
  const auto value = [&](const Signal& signal) { return read_signal(signal, kOrder, frame); };
  if (command == kStatus1Id) {
    feedback.time = time;
    feedback.speed_rad_s = value(kStatus1[0]) * axis.rad_s_per_erpm;
    feedback.current_a = value(kStatus1[1]);
    axis.was_heard = true;
  } else if (command == kStatus4Id) {
    feedback.temperature_k = value(kStatus4[0]) + kKelvinAt0C;
  } else {
    feedback.voltage_v = value(kStatus5[1]);
  }
}

bool VescDrive::take_answer(const CanFrame& frame, TimePoint time) {
  if (frame.length > frame.data.size()) return false;
  const auto answer = answer_from(frame);
  if (!answer) return false;
  const int i = axis_of_[static_cast<std::size_t>(answer->node)];
  if (i < 0) return true;
  Axis& axis = axes_[static_cast<std::size_t>(i)];
  DriveFeedback& feedback = feedback_[static_cast<std::size_t>(i)];
  if (answer->mask == kFaultMask) {
    if (answer->value != 0 && feedback.fault_code == 0) ++feedback.error_count;
    feedback.fault_code = answer->value;
    axis.tells_fault = true;
    axis.told = time;
  } else if (answer->mask == kTimeoutMask) {
    const bool has_timed_out = (answer->value & 1) != 0;
    if (has_timed_out && is_silent(axis, time)) axis.guard = Guard::kProven;
  } else {
    return false;
  }
  return true;
}

// ---- frames out ---------------------------------------------------------------------------------

// Stops are repeated for a while, then a VESC that is there is left alone.
bool VescDrive::is_silent(const Axis& axis, TimePoint now) const {
  return has_started_ && !is_enabled_ && now - std::max(disabled_, axis.absent) > stop_time_;
}

bool VescDrive::is_command_due(bool enable, TimePoint now) {
  const bool is_change = !has_started_ || enable != is_enabled_;
  if (is_change && !enable) disabled_ = now;
  has_started_ = true;
  is_enabled_ = enable;
  // Stops have no period: the bus may refuse one.
  if (enable && !is_change && now - last_command_ < command_period_) return false;
  last_command_ = now;
  return true;
}

CanFrame VescDrive::command(const Axis& axis, std::optional<double> setpoint) const {
  if (setpoint) return set_frame(mode_, signal_of(mode_), axis.node, *setpoint * axis.full);
  if (config_.stop == "brake") {
    return set_frame(kSetCurrentBrake, kBrakeCurrent, axis.node, config_.brake_current_a);
  }
  return set_frame(kSetCurrent, kCurrent, axis.node, 0);
}

int VescDrive::send(std::span<const DriveSetpoint> setpoints, bool enable, TimePoint now,
                    std::span<CanFrame> out) {
  const bool is_first = !has_started_;
  watch(now);
  std::size_t n = 0;
  if (is_command_due(enable, now)) {
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      if (is_silent(axes_[i], now)) continue;
      axes_[i].commanded = now;
      const bool is_good = i < setpoints.size() && !std::isnan(setpoints[i].value);
      if (enable && !is_good) ++bad_setpoints_;
      std::optional<double> setpoint;
      if (enable && is_good) setpoint = std::clamp(setpoints[i].value, -1.0, 1.0);
      out[n++] = command(axes_[i], setpoint);
    }
  }
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Axis& axis = axes_[i];
    if (is_first) axis.next_question = now + kQuestionStep * static_cast<int>(i);
    if (now < axis.next_question) continue;
    axis.next_question = std::max(axis.next_question + kQuestionPeriod, now);
    out[n++] =
        question_frame(own_id_, axis.node, axis.asks_for_timeout ? kTimeoutMask : kFaultMask);
    axis.asks_for_timeout = !axis.asks_for_timeout;
  }
  set_states(now);
  return static_cast<int>(n);
}

// ---- health -------------------------------------------------------------------------------------

bool VescDrive::is_alive(std::size_t i, TimePoint now) const {
  const Axis& axis = axes_[i];
  return axis.was_heard && now - feedback_[i].time <= feedback_timeout_ &&
         (!axis.tells_fault || now - axis.told <= kAnswerAge);
}

const char* VescDrive::trouble(std::size_t i, TimePoint now) const {
  const Axis& axis = axes_[i];
  if (axis.tells_fault && now - axis.told > kAnswerAge &&
      now - feedback_[i].time <= feedback_timeout_)
    return "it no longer tells its fault";
  if (!is_alive(i, now)) return "";
  if (!axis.tells_fault) return "it has not yet told its fault";
  return axis.guard == Guard::kMissing ? "its own time-out does not pass"
                                       : "its own time-out has not yet been seen";
}

bool VescDrive::is_guarded(const Axis& axis) const {
  return axis.guard == Guard::kProven || config_.accept_unguarded;
}

void VescDrive::watch(TimePoint now) {
  const Duration limit = from_seconds(config_.guard_time_s);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Guard& guard = axes_[i].guard;
    if (now - axes_[i].told > kAnswerAge) feedback_[i].fault_code = 0;
    if (!is_alive(i, now)) {
      guard = Guard::kUnknown;  // it may come back as another, or set otherwise
      axes_[i].absent = now;
    } else if (guard == Guard::kUnknown && is_silent(axes_[i], now) &&
               now - std::max(axes_[i].commanded, axes_[i].absent) > limit) {
      guard = Guard::kMissing;
    }
  }
}

void VescDrive::set_states(TimePoint now) {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    feedback_[i].state = feedback_[i].fault_code != 0 ? DriveState::kFault
                         : !is_alive(i, now)          ? DriveState::kUnknown
                         : is_enabled_                ? DriveState::kEnabled
                                                      : DriveState::kDisabled;
  }
}

DriveGroupHealth VescDrive::health(TimePoint now) const {
  DriveGroupHealth health = {.all_alive = true};
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const Axis& axis = axes_[i];
    const int fault = feedback_[i].fault_code;
    const bool alive = is_alive(i, now), faulty = fault != 0;
    const bool guarded = is_guarded(axis) || axis.guard == Guard::kUnknown;
    const bool ready =
        alive && axis.tells_fault && (is_guarded(axis) || axis.guard == Guard::kMissing);
    health.all_alive = health.all_alive && alive;
    health.any_fault = health.any_fault || faulty;
    health.all_ready = health.all_ready && ready;
    health.guards_itself = health.guards_itself && guarded;
    if (health.first_bad >= 0 || (alive && !faulty && ready && guarded)) continue;
    health.first_bad = static_cast<int>(i);
    if (faulty) {
      health.trouble = words_of_fault(fault);
      health.trouble_code = static_cast<std::uint32_t>(fault);
    } else {
      health.trouble = trouble(i, now);
    }
  }
  return health;
}

}  // namespace gannet::hal
