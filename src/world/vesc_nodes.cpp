#include "src/world/vesc_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "src/world/thruster.hpp"

namespace gannet::world {

using hal::CanFrame;
using Bytes = std::array<std::uint8_t, 8>;

namespace {

constexpr double kRpmPerRadPerS = 60 / (2 * std::numbers::pi);
constexpr double kKelvinAt0C = 273.15;
constexpr std::uint8_t kOverCurrent = 4;
constexpr Duration kPhaseStep = std::chrono::milliseconds(1);
enum : std::uint32_t { kDuty, kCurrent, kBrake, kSpeed, kShort = 8, kStatus = 9, kStatus4 = 16 };
constexpr std::uint32_t kStatus5 = 27;

std::int32_t int32_at(const CanFrame& frame, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = at; i < at + 4; ++i) value = value << 8 | frame.data[i];
  return static_cast<std::int32_t>(value);
}

void put(Bytes& bytes, std::size_t at, int size, double value) {
  const auto number = static_cast<std::uint32_t>(std::lround(value));
  for (int i = 0; i < size; ++i) {
    bytes[at + static_cast<std::size_t>(i)] =
        static_cast<std::uint8_t>(number >> 8 * (size - 1 - i));
  }
}

}  // namespace

VescNodes::VescNodes(const hal::DriveConfig& drives, const VescBehaviour& behaviour,
                     std::uint64_t seed)
    : config_(drives.vesc), behaviour_(behaviour), throttles_(drives.motors.size()), random_(seed) {
  for (const hal::MotorConfig& motor : drives.motors) {
    Node& node = nodes_.emplace_back();
    node.id = static_cast<std::uint32_t>(motor.node_id);
    node.sign = motor.reversed ? -1 : 1;
    node.pole_pairs = motor.pole_pairs;
  }
}

std::span<const double> VescNodes::step(TimePoint now, std::span<const CanFrame> in,
                                        std::vector<CanFrame>& out) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    Node& node = nodes_[i];
    if (!has_begun_) node.commanded = now;
    if (!has_begun_) node.next_status = now + kPhaseStep * static_cast<int>(i);
    if (!node.faults.silent) {
      for (const CanFrame& frame : in) hear(node, frame, now);
      if (now >= node.next_status) tell_status(node, now);
    }
    node.mouth.deliver(node.faults, now, out);
    const bool turns = !node.faults.faulty && !has_timed_out(node, now);
    throttles_[i] = turns ? node.sign * node.throttle : 0.0;
  }
  const auto is_quiet = [&](const Node& node) { return has_timed_out(node, now); };
  if (std::all_of(nodes_.begin(), nodes_.end(), is_quiet)) armed_ = false;
  for (const CanFrame& frame : in) {  // also what a silent node does not hear
    if (!frame.extended || frame.length != 4 || frame.id >> 8 > kSpeed) continue;
    const std::uint32_t command = frame.id >> 8;
    armed_ = command != kBrake && (command != kCurrent || int32_at(frame, 0) != 0);
  }
  has_begun_ = true;
  return throttles_;
}

bool VescNodes::has_timed_out(const Node& node, TimePoint now) const {
  return behaviour_.timeout_s > 0 && now - node.commanded > from_seconds(behaviour_.timeout_s);
}

// ---- in -----------------------------------------------------------------------------------------

void VescNodes::hear(Node& node, const CanFrame& frame, TimePoint now) {
  if (!frame.extended || (frame.id & 0xFF) != node.id) return;
  const std::uint32_t command = frame.id >> 8;
  if (command == kShort) return answer(node, frame, now);
  if (command > kSpeed || frame.length < 4) return;
  const double number = int32_at(frame, 0);
  if (command == kDuty) {
    node.throttle = number / 100000 / config_.full_duty;
  } else if (command == kCurrent) {
    node.throttle = number / 1000 / config_.full_current_a;
  } else if (command == kSpeed) {
    const double speed = node.sign * number / node.pole_pairs / kRpmPerRadPerS;
    node.throttle = node.sign * throttle_at_speed(speed);
  } else {
    node.throttle = 0;
  }
  node.throttle = std::clamp(node.throttle, -1.0, 1.0);
  node.commanded = now;
}

// COMM_GET_VALUES_SELECTIVE of the fault code, or of the status that says the time-out.
void VescNodes::answer(Node& node, const CanFrame& question, TimePoint now) {
  constexpr std::uint8_t kGetValuesSelective = 50;
  if (question.length != 7 || question.data[1] != 0 || question.data[2] != kGetValuesSelective) {
    return;
  }
  const auto mask = static_cast<std::uint32_t>(int32_at(question, 3));
  Bytes bytes = question.data;
  if (mask == 1u << 15) {
    bytes[7] = node.faults.faulty ? kOverCurrent : 0;
  } else if (mask == 1u << 21) {
    bytes[7] = has_timed_out(node, now) ? 1 : 0;
  } else {
    return;
  }
  bytes[0] = static_cast<std::uint8_t>(node.id);
  bytes[1] = 1;
  const CanFrame frame = {
      .id = kShort << 8 | question.data[0], .extended = true, .length = 8, .data = bytes};
  node.mouth.say(frame, node.faults, random_, now);
}

// ---- out ----------------------------------------------------------------------------------------

void VescNodes::tell_status(Node& node, TimePoint now) {
  node.next_status = std::max(node.next_status + from_seconds(1 / behaviour_.status_hz), now);
  const MotorReport& report = node.report;
  Bytes status = {}, status4 = {}, status5 = {};
  put(status, 0, 4, node.sign * report.speed_rad_s * kRpmPerRadPerS * node.pole_pairs);
  put(status, 4, 2, report.current_a * 10);
  put(status, 6, 2, node.throttle * config_.full_duty * 1000);
  put(status4, 0, 2, (report.temperature_k - kKelvinAt0C) * 10);
  put(status4, 2, 2, (report.temperature_k - kKelvinAt0C) * 10);
  put(status4, 4, 2, report.current_a * 10);
  put(status5, 4, 2, report.voltage_v * 10);
  say(node, kStatus, status, now);
  say(node, kStatus4, status4, now);
  say(node, kStatus5, status5, now);
}

void VescNodes::say(Node& node, std::uint32_t command, const Bytes& data, TimePoint now) {
  const CanFrame frame = {
      .id = command << 8 | node.id, .extended = true, .length = 8, .data = data};
  node.mouth.say(frame, node.faults, random_, now);
}

}  // namespace gannet::world
