#include "hal/drive/odrive_axis.hpp"

#include <algorithm>
#include <limits>

namespace gannet::hal::odrive {
namespace {

constexpr Duration kAskAgain = std::chrono::milliseconds(100);
constexpr Duration kEnableTime = std::chrono::seconds(1);       // enable to closed loop
constexpr Duration kIdleTime = std::chrono::milliseconds(300);  // to idle, else Estop
constexpr double kKelvinAt0C = 273.15;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const MessageAbout* message_of(std::uint32_t command) {
  for (const MessageAbout& message : kMessages) {
    if (message.command == command && message.from_drive) return &message;
  }
  return nullptr;
}

}  // namespace

OdriveAxis::OdriveAxis(const AxisSettings& settings) : settings_(settings) {
  feedback_.current_a = feedback_.voltage_v = feedback_.temperature_k = kNan;
}

// ---- in -----------------------------------------------------------------------------------------

bool OdriveAxis::hear(const CanFrame& frame, TimePoint time) {
  const std::uint32_t command = frame.id & 0x1F;
  const MessageAbout* message = message_of(command);
  if (message == nullptr) return true;
  if (frame.length != message->length) return false;
  const auto value = [&](const Signal& signal) { return read_signal(signal, kOrder, frame); };
  switch (command) {
    case kHeartbeatId:
      hear_heartbeat(frame, time);
      break;
    case kGetEstimates:
      feedback_.time = time;
      feedback_.speed_rad_s = value(kEstimates[1]) / settings_.turns_per_rad;
      has_estimates_ = true;
      break;
    case kGetIq:
      feedback_.current_a = value(kIq[1]);
      break;
    case kGetTemperature:
      if (!settings_.is_firmware_05)
        feedback_.temperature_k = value(kTemperatures[0]) + kKelvinAt0C;
      break;
    case kGetBus:
      feedback_.voltage_v = value(kBus[0]);
      break;
    default:
      break;
  }
  return true;
}

void OdriveAxis::hear_heartbeat(const CanFrame& frame, TimePoint time) {
  const auto error = static_cast<std::uint32_t>(read_signal(kError, kOrder, frame));
  if (error != 0 && error_ == 0) ++feedback_.error_count;
  error_ = error;
  state_ = static_cast<std::uint32_t>(read_signal(kState, kOrder, frame));
  heartbeat_ = time;
  has_heartbeat_ = true;
}

// ---- out ----------------------------------------------------------------------------------------

int OdriveAxis::speak(std::optional<double> setpoint, bool enable, TimePoint now,
                      std::span<CanFrame> out) {
  if (!has_started_ || enable != is_enabled_) {
    since_ = now;
    asked_ = now - kAskAgain;
    has_run_ = false;
    trip_ = Trip::kNone;
    if (!has_started_) absent_ = now;
  }
  has_started_ = true;
  is_enabled_ = enable;
  watch(enable, now);
  const bool runs = enable && !is_faulty();
  const double speed = setpoint.value_or(0) * settings_.full_turns_per_s;
  int n = runs ? run(speed, now, out) : stop(now, out);
  if (wants_reset_ && !enable) {
    out[static_cast<std::size_t>(n++)] = frame_of(kClearErrors, settings_.node);
    trip_ = Trip::kNone;
  }
  wants_reset_ = false;
  if (n > 0) spoken_ = now;
  set_state(now);
  return n;
}

int OdriveAxis::stop(TimePoint now, std::span<CanFrame> out) {
  const bool is_idle = has_heartbeat_ && state_ == kIdle && heartbeat_ > since_;
  // A request may be lost or refused by the bus.
  if (is_idle || (now - since_ > kIdleTime && now - asked_ < kAskAgain)) return 0;
  asked_ = now;
  std::size_t n = 0;
  out[n++] = state_frame(settings_.node, kIdle);
  if (state_ == kClosedLoop && now - since_ > kIdleTime) {
    out[n++] = frame_of(kEstop, settings_.node);
  }
  return static_cast<int>(n);
}

int OdriveAxis::run(double turns_per_s, TimePoint now, std::span<CanFrame> out) {
  const int node = settings_.node;
  std::size_t n = 0;
  if (has_run_) {
    out[n++] = velocity_frame(node, turns_per_s);
    return static_cast<int>(n);
  }
  if (now - asked_ >= kAskAgain) {
    asked_ = now;
    if (error_ != 0) out[n++] = frame_of(kClearErrors, node);
    out[n++] = mode_frame(node, settings_.input_mode);
    out[n++] = velocity_frame(node, 0);
    out[n++] = state_frame(node, kClosedLoop);
  } else {  // feeds the watchdog; a mode that got lost would else stay another
    out[n++] = mode_frame(node, settings_.input_mode);
    out[n++] = velocity_frame(node, 0);
  }
  return static_cast<int>(n);
}

// ---- watched ------------------------------------------------------------------------------------

bool OdriveAxis::is_alive(TimePoint now) const {
  return has_heartbeat_ && has_estimates_ && now - heartbeat_ <= settings_.heartbeat_timeout &&
         now - feedback_.time <= settings_.feedback_timeout;
}

void OdriveAxis::watch(bool enable, TimePoint now) {
  if (!is_alive(now)) {
    guard_ = Guard::kUnknown;  // it may come back as another, or set otherwise
    absent_ = now;
  }
  const bool has_expired = (error_ & watchdog_bit()) != 0;
  if (!enable) {
    if (!is_alive(now)) return;
    if (has_expired && heartbeat_ > spoken_) guard_ = Guard::kProven;
    const bool should_have = now - std::max(spoken_, absent_) > settings_.guard_time;
    if (guard_ == Guard::kUnknown && should_have) guard_ = Guard::kMissing;
    return;
  }
  const bool is_news = heartbeat_ > since_;
  if (trip_ != Trip::kNone || !is_news) return;
  if (state_ == kClosedLoop && error_ == 0) {
    has_run_ = true;
  } else if (has_run_) {
    trip_ = Trip::kLeftClosedLoop;
    since_ = now;  // idle is asked for from now
  } else if (now - since_ > kEnableTime) {
    trip_ = Trip::kDidNotEnable;
    since_ = now;
  }
}

void OdriveAxis::set_state(TimePoint now) {
  const std::uint32_t error = other_errors() != 0 ? other_errors() : error_;
  const auto code = (error & 0xFFFF) != 0 ? error & 0xFFFF : error >> 16;
  feedback_.fault_code = !is_faulty() ? std::uint16_t{0}
                         : error != 0 ? static_cast<std::uint16_t>(code)
                                      : static_cast<std::uint16_t>(trip_);
  feedback_.state = is_faulty()      ? DriveState::kFault
                    : !is_alive(now) ? DriveState::kUnknown
                    : is_enabled_    ? DriveState::kEnabled
                                     : DriveState::kDisabled;
}

const char* OdriveAxis::trouble() const {
  if (other_errors() != 0) return words_of_error(other_errors(), settings_.is_firmware_05);
  if (error_ != 0) return words_of_error(error_, settings_.is_firmware_05);
  return trip_ == Trip::kDidNotEnable ? "it did not enter closed loop" : "it left closed loop";
}

}  // namespace gannet::hal::odrive
