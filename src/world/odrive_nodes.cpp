#include "src/world/odrive_nodes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "src/world/thruster.hpp"

namespace gannet::world {

using hal::CanFrame;

namespace {

constexpr double kTurn = 2 * std::numbers::pi, kKelvinAt0C = 273.15;
constexpr std::uint8_t kIdle = 1, kClosedLoop = 8;
constexpr std::uint32_t kVelocityControl = 2;
constexpr std::uint32_t kEstopError = 0x02000000, kEstopError05 = 0x4000;
constexpr std::uint32_t kMotorError05 = 0x40, kGateDriverError = 0x20;
constexpr Duration kPhaseStep = std::chrono::milliseconds(1);

std::uint32_t uint32_at(const CanFrame& frame, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i > 0; --i) value = value << 8 | frame.data[at + i - 1];
  return value;
}

void put(CanFrame& frame, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) {
    frame.data[at + i] = static_cast<std::uint8_t>(value >> 8 * i);
  }
}

}  // namespace

OdriveNodes::OdriveNodes(const hal::DriveConfig& drives, const OdriveBehaviour& behaviour,
                         std::uint64_t seed)
    : behaviour_(behaviour),
      watchdog_error_(drives.odrive.firmware == "0.5" ? 0x800 : 0x01000000),
      throttles_(drives.motors.size()),
      random_(seed) {
  for (const hal::MotorConfig& motor : drives.motors) {
    Node& node = nodes_.emplace_back();
    node.id = static_cast<std::uint32_t>(motor.node_id);
    node.sign = motor.reversed ? -1 : 1;
  }
}

void OdriveNodes::begin(TimePoint now) {
  has_begun_ = true;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    Node& node = nodes_[i];
    node.fed = now;
    node.next_heartbeat = node.next_encoder = node.next_others =
        now + kPhaseStep * static_cast<int>(i);
  }
}

std::span<const double> OdriveNodes::step(TimePoint now, std::span<const CanFrame> in,
                                          std::vector<CanFrame>& out) {
  if (!has_begun_) begin(now);
  for (const CanFrame& frame : in) {  // also what a silent node does not hear
    if (!frame.extended && (frame.id & 0x1F) == 0x07) armed_ = frame.data[0] == kClosedLoop;
  }
  const bool is_05 = watchdog_error_ == 0x800;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    Node& node = nodes_[i];
    if (!node.faults.silent) {
      for (const CanFrame& frame : in) hear(node, frame, now);
    }
    if (node.faults.faulty) raise(node, is_05 ? kMotorError05 : kGateDriverError);
    const bool has_watchdog = behaviour_.watchdog_s > 0;
    if (has_watchdog && now - node.fed > from_seconds(behaviour_.watchdog_s)) {
      raise(node, watchdog_error_);
    }
    if (!node.faults.silent) speak(node, now);
    node.mouth.deliver(node.faults, now, out);
    const bool turns = node.state == kClosedLoop && node.control_mode == kVelocityControl;
    throttles_[i] = turns ? throttle_at_speed(node.sign * node.velocity * kTurn) : 0.0;
  }
  return throttles_;
}

void OdriveNodes::raise(Node& node, std::uint32_t error) {
  node.error |= error;
  node.state = kIdle;
}

// ---- in -----------------------------------------------------------------------------------------

void OdriveNodes::hear(Node& node, const CanFrame& frame, TimePoint now) {
  if (frame.extended || frame.id >> 5 != node.id) return;
  node.fed = now;
  switch (frame.id & 0x1F) {
    case 0x02:  // Estop
      raise(node, watchdog_error_ == 0x800 ? kEstopError05 : kEstopError);
      break;
    case 0x07:  // Set_Axis_State
      if (frame.length < 4) break;
      if (uint32_at(frame, 0) == kIdle) node.state = kIdle;
      if (uint32_at(frame, 0) == kClosedLoop && node.error == 0) node.state = kClosedLoop;
      break;
    case 0x0B:  // Set_Controller_Mode
      if (frame.length == 8) node.control_mode = uint32_at(frame, 0);
      break;
    case 0x0D:  // Set_Input_Vel
      if (frame.length == 8) node.velocity = std::bit_cast<float>(uint32_at(frame, 0));
      break;
    case 0x18:  // Clear_Errors
      node.error = 0;
      break;
    default:
      break;
  }
}

// ---- out ----------------------------------------------------------------------------------------

void OdriveNodes::speak(Node& node, TimePoint now) {
  const auto is_due = [&](TimePoint& next, double hz) {
    if (now < next) return false;
    next = std::max(next + from_seconds(1 / hz), now);
    return true;
  };
  const MotorReport& report = node.report;
  if (is_due(node.next_heartbeat, behaviour_.heartbeat_hz)) {
    CanFrame frame = {.id = node.id << 5 | 0x01, .length = 8};
    put(frame, 0, node.error);
    frame.data[4] = node.state;
    node.mouth.say(frame, node.faults, random_, now);
  }
  if (is_due(node.next_encoder, behaviour_.encoder_hz)) {
    say(node, 0x09, 0, node.sign * report.speed_rad_s / kTurn, now);
  }
  if (!is_due(node.next_others, behaviour_.others_hz)) return;
  say(node, 0x14, report.current_a, report.current_a, now);
  say(node, 0x17, report.voltage_v, report.current_a, now);
  if (watchdog_error_ != 0x800) {
    say(node, 0x15, report.temperature_k - kKelvinAt0C, report.temperature_k - kKelvinAt0C, now);
  }
}

void OdriveNodes::say(Node& node, std::uint32_t command, double first, double second,
                      TimePoint now) {
  CanFrame frame = {.id = node.id << 5 | command, .length = 8};
  put(frame, 0, std::bit_cast<std::uint32_t>(static_cast<float>(first)));
  put(frame, 4, std::bit_cast<std::uint32_t>(static_cast<float>(second)));
  node.mouth.say(frame, node.faults, random_, now);
}

}  // namespace gannet::world
