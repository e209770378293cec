#include "src/world/esc_node.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gannet::world {

using namespace hal::dronecan;

namespace {

constexpr std::uint8_t kStatusPriority = 16;
constexpr Duration kHeartbeatPeriod = std::chrono::seconds(1);
constexpr Duration kPhaseStep = std::chrono::milliseconds(3);
constexpr std::uint16_t kFaultCode = 1;
constexpr int kListenerId = 127;  // speaks to nobody; requests to it do not exist
constexpr double kRpmPerRadPerS = 60 / (2 * std::numbers::pi);

std::uint8_t counted(std::uint8_t& transfer_id) {
  const std::uint8_t id = transfer_id;
  transfer_id = static_cast<std::uint8_t>((transfer_id + 1) % kTransferIds);
  return id;
}

}  // namespace

EscNodes::Node::Node(std::uint8_t node_id, Duration node_phase)
    : id(node_id),
      phase(node_phase),
      receiver({subscription_to<RawCommand>(), subscription_to<ArmingStatus>(),
                subscription_to<NodeInfo>(TransferKind::kRequest)},
               node_id, 16) {}

EscNodes::EscNodes(const hal::DriveConfig& drives, const EscBehaviour& behaviour,
                   std::uint64_t seed)
    : motors_(drives.motors),
      range_(hal::esc_range(drives.range).value_or(hal::EscRange{})),
      behaviour_(behaviour),
      reports_(drives.motors.size()),
      asked_(drives.motors.size()),
      commanded_(drives.motors.size()),
      random_(seed),
      ear_({subscription_to<ArmingStatus>()}, kListenerId, 4) {
  for (std::size_t motor = 0; motor < motors_.size(); ++motor) {
    const auto id = static_cast<std::uint8_t>(motors_[motor].node_id);
    auto node = std::find_if(nodes_.begin(), nodes_.end(), [&](auto& n) { return n.id == id; });
    if (node == nodes_.end()) {
      nodes_.emplace_back(id, kPhaseStep * static_cast<int>(nodes_.size()));
      node = nodes_.end() - 1;
    }
    node->motors.push_back(motor);
    node_of_.push_back(static_cast<std::size_t>(node - nodes_.begin()));
  }
}

std::span<const double> EscNodes::step(TimePoint now, std::span<const hal::CanFrame> in,
                                       std::vector<hal::CanFrame>& out) {
  if (!has_begun_) begin(now);
  for (const hal::CanFrame& frame : in) listen_for_arming(frame, now);
  for (Node& node : nodes_) {
    if (node.faults.faulty && !node.was_faulty) ++node.error_count;
    node.was_faulty = node.faults.faulty;
    if (!node.faults.silent) {
      for (const hal::CanFrame& frame : in) hear(node, frame, now);
      speak(node, now);
    }
    node.mouth.deliver(node.faults, now, out);
    for (std::size_t motor : node.motors) commanded_[motor] = turns(node, now) ? asked_[motor] : 0;
  }
  return commanded_;
}

void EscNodes::begin(TimePoint now) {
  has_begun_ = true;
  start_ = now;
  for (Node& node : nodes_) node.next_heartbeat = node.next_status = now + node.phase;
}

bool EscNodes::turns(const Node& node, TimePoint now) const {
  return node.is_commanded && !node.faults.faulty && (node.is_armed || !behaviour_.needs_arming) &&
         now - node.command_time <= from_seconds(behaviour_.command_timeout_s);
}

// ---- in -----------------------------------------------------------------------------------------

void EscNodes::listen_for_arming(const hal::CanFrame& frame, TimePoint now) {
  const auto transfer = ear_.receive(frame, now);
  ArmingStatus status;
  if (transfer && decode(transfer->payload, status)) {
    armed_ = status.status == ArmingStatus::kArmed;
  }
}

void EscNodes::hear(Node& node, const hal::CanFrame& frame, TimePoint now) {
  const auto transfer = node.receiver.receive(frame, now);
  if (!transfer) return;
  if (transfer->header.kind == TransferKind::kRequest) {
    say_info(node, transfer->header, now);
  } else if (transfer->header.type_id == RawCommand::kType.id) {
    RawCommand command;
    if (decode(transfer->payload, command)) obey(node, command, now);
  } else {
    ArmingStatus status;
    if (decode(transfer->payload, status)) node.is_armed = status.status == ArmingStatus::kArmed;
  }
}

void EscNodes::obey(Node& node, const RawCommand& command, TimePoint now) {
  for (std::size_t motor : node.motors) {
    const hal::MotorConfig& config = motors_[motor];
    if (config.index >= command.commands.size()) continue;  // not for us: the time-out runs on
    const double fraction = hal::fraction_of(range_, command.commands[config.index]);
    asked_[motor] = config.reversed ? 0.0 - fraction : fraction;
    node.is_commanded = true;
    node.command_time = now;
  }
}

// ---- out ----------------------------------------------------------------------------------------

void EscNodes::speak(Node& node, TimePoint now) {
  if (now >= node.next_heartbeat) {
    say(node, status_of(node, now),
        {.type_id = NodeStatus::kType.id,
         .priority = kStatusPriority,
         .source = node.id,
         .transfer_id = counted(node.heartbeat_id)},
        now);
    node.next_heartbeat = std::max(node.next_heartbeat + kHeartbeatPeriod, now);
  }
  if (now < node.next_status) return;
  for (std::size_t motor : node.motors) {
    if (motors_[motor].has_feedback) say_status(node, motor, now);
  }
  node.next_status = std::max(node.next_status + from_seconds(1 / behaviour_.status_hz), now);
}

NodeStatus EscNodes::status_of(const Node& node, TimePoint now) const {
  NodeStatus status = {.uptime_s = static_cast<std::uint32_t>(to_seconds(now - start_))};
  if (node.faults.faulty) {
    status.health = NodeStatus::kCritical;
    status.vendor_status = kFaultCode;
  }
  return status;
}

void EscNodes::say_status(Node& node, std::size_t motor, TimePoint now) {
  const hal::MotorConfig& config = motors_[motor];
  const MotorReport& report = reports_[motor];
  const double sign = config.reversed ? -1 : 1;
  const EscStatus status = {
      .error_count = node.error_count,
      .voltage_v = static_cast<float>(report.voltage_v),
      .current_a = static_cast<float>(report.current_a),
      .temperature_k = static_cast<float>(report.temperature_k),
      .rpm = static_cast<std::int32_t>(
          std::lround(sign * report.speed_rad_s * kRpmPerRadPerS * config.pole_pairs)),
      .power_percent = static_cast<std::uint8_t>(std::lround(100 * std::fabs(commanded_[motor]))),
      .esc_index = static_cast<std::uint8_t>(config.index)};
  say(node, status,
      {.type_id = EscStatus::kType.id,
       .priority = kStatusPriority,
       .source = node.id,
       .transfer_id = counted(node.status_id)},
      now);
}

void EscNodes::say_info(Node& node, const TransferHeader& request, TimePoint now) {
  NodeInfo info;
  info.status = status_of(node, now);
  info.software_major = info.hardware_major = 1;
  info.unique_id[15] = node.id;
  info.set_name("org.gannet.world.esc");
  say(node, info,
      {.kind = TransferKind::kResponse,
       .type_id = NodeInfo::kType.id,
       .priority = request.priority,
       .source = node.id,
       .destination = request.source,
       .transfer_id = request.transfer_id},
      now);
}

template <class Message>
void EscNodes::say(Node& node, const Message& message, const TransferHeader& header,
                   TimePoint now) {
  hal::CanFrame frames[frames_of(kMaxPayload)];
  const int count = to_frames(message, header, frames);
  for (const hal::CanFrame& frame : std::span(frames).first(static_cast<std::size_t>(count))) {
    node.mouth.say(frame, node.faults, random_, now);
  }
}

}  // namespace gannet::world
