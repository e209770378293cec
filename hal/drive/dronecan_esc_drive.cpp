#include "hal/drive/dronecan_esc_drive.hpp"

#include <algorithm>
#include <cstdio>
#include <numbers>
#include <string>

namespace gannet::hal {

using namespace dronecan;

namespace {

constexpr std::uint8_t kCommandPriority = 8, kStatusPriority = 16, kServicePriority = 24;
constexpr Duration kArmingPeriod = std::chrono::milliseconds(500);
constexpr Duration kUrgentStops = std::chrono::milliseconds(300);  // in each cycle: one may be lost
constexpr Duration kHeartbeatPeriod = std::chrono::seconds(1);
constexpr Duration kConflictTime = std::chrono::seconds(2);  // heartbeats come once a second
constexpr double kRadPerSPerRpm = 2 * std::numbers::pi / 60;

std::vector<Subscription> subscriptions() {
  return {subscription_to<EscStatus>(), subscription_to<NodeStatus>(),
          subscription_to<Allocation>(), subscription_to<NodeInfo>(TransferKind::kRequest),
          subscription_to<NodeInfo>(TransferKind::kResponse)};
}

Result<void> check(const DriveConfig& config) {
  if (config.motors.empty()) return Error{"drive: no motor is configured; add [[drive.motor]]"};
  if (config.own_node_id < 1 || config.own_node_id > kMaxNodeId) {
    return Error{"drive.own_node_id must be 1 to 127"};
  }
  for (std::size_t i = 0; i < config.motors.size(); ++i) {
    const MotorConfig& motor = config.motors[i];
    const std::string name = "drive.motor " + std::to_string(i + 1) + ": ";
    if (motor.index < 0 || motor.index >= RawCommand::kMaxEscs) {
      return Error{name + "index must be 0 to 19"};
    }
    if (motor.node_id < 1 || motor.node_id > kMaxNodeId) {
      return Error{name + "node_id must be 1 to 127"};
    }
    if (motor.node_id == config.own_node_id) {
      return Error{name + "node_id " + std::to_string(motor.node_id) + " is drive.own_node_id"};
    }
    if (motor.pole_pairs < 1) return Error{name + "pole_pairs must be at least 1"};
    for (std::size_t other = 0; other < i; ++other) {
      if (config.motors[other].index == motor.index) {
        return Error{name + "index " + std::to_string(motor.index) + " is also that of motor " +
                     std::to_string(other + 1)};
      }
    }
  }
  return {};
}

NodeInfo make_own_info(int own_node_id) {
  NodeInfo info;
  int major = 0, minor = 0;
  std::sscanf(GANNET_VERSION, "%d.%d", &major, &minor);
  info.software_major = static_cast<std::uint8_t>(major);
  info.software_minor = static_cast<std::uint8_t>(minor);
  const std::string_view tag = "gannet";  // no serial number: unique on one bus, like the node id
  std::copy(tag.begin(), tag.end(), info.unique_id.begin());
  info.unique_id.back() = static_cast<std::uint8_t>(own_node_id);
  info.set_name("org.gannet.daemon");
  return info;
}

}  // namespace

Result<std::unique_ptr<DroneCanEscDrive>> DroneCanEscDrive::create(const DriveConfig& config) {
  if (auto good = check(config); !good) return good.error();
  const auto range = esc_range(config.range);
  if (!range) return Error{"drive.range '" + config.range + "' is unknown"};
  std::vector<std::uint8_t> ids;
  for (const MotorConfig& motor : config.motors) {
    const auto id = static_cast<std::uint8_t>(motor.node_id);
    if (std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
  }
  return std::unique_ptr<DroneCanEscDrive>(new DroneCanEscDrive(config, *range, ids));
}

DroneCanEscDrive::DroneCanEscDrive(const DriveConfig& config, const EscRange& range,
                                   std::span<const std::uint8_t> node_ids)
    : motors_(config.motors),
      range_(range),
      own_id_(static_cast<std::uint8_t>(config.own_node_id)),
      feedback_timeout_(from_seconds(config.feedback_timeout_s)),
      sends_arming_(config.arming_status),
      is_guarded_(config.dronecan.is_guarded() || config.dronecan.accept_unguarded),
      own_info_(make_own_info(config.own_node_id)),
      receiver_(subscriptions(), config.own_node_id),
      watch_(node_ids, from_seconds(config.node_timeout_s)),
      feedback_(config.motors.size()),
      has_status_(config.motors.size()),
      command_timer_{.period = from_seconds(config.command_period_s)},
      arming_timer_{.period = kArmingPeriod},
      heartbeat_timer_{.period = kHeartbeatPeriod} {
  int escs = 0;
  for (const MotorConfig& motor : motors_) escs = std::max(escs, motor.index + 1);
  // An index between ours that is nobody's gets the range's stop too.
  for (int i = 0; i < escs; ++i) command_.commands.push_back(range_.stop);
}

std::vector<CanFilter> DroneCanEscDrive::wanted_frames(const DriveConfig& config) {
  std::vector<CanFilter> filters;
  for (const Subscription& s : subscriptions()) {
    filters.push_back(filter_for(s, config.own_node_id));
  }
  return filters;
}

// RawCommand, at 14 bits for each index; arming 1, heartbeat 1, answer 10, request 1; one to spare.
int DroneCanEscDrive::max_frames() const {
  return frames_of((14 * command_.commands.size() + 7) / 8) + 14;
}

// ---- frames in ----------------------------------------------------------------------------------

void DroneCanEscDrive::receive(const CanFrame& frame, TimePoint time) {
  const auto sender = header_of(frame);
  if (sender && sender->source == own_id_) {
    ++counters_.own_id_conflicts;
    conflict_ = time;
    return;
  }
  if (const auto transfer = receiver_.receive(frame, time)) take(*transfer, time);
}

void DroneCanEscDrive::take(const Transfer& transfer, TimePoint time) {
  const TransferHeader& from = transfer.header;
  if (from.kind == TransferKind::kRequest) {  // GetNodeInfo; one too many is asked again
    clients_.push_back({from.source, from.transfer_id, from.priority});
  } else if (from.kind == TransferKind::kResponse) {
    NodeInfo info;
    if (!decode(transfer.payload, info))
      ++malformed_;
    else
      watch_.hear(from.source, info);
  } else if (from.type_id == EscStatus::kType.id) {
    EscStatus status;
    if (!decode(transfer.payload, status))
      ++malformed_;
    else
      take_status(from.source, status, time);
  } else if (from.type_id == NodeStatus::kType.id) {
    NodeStatus status;
    if (from.source == 0 || !decode(transfer.payload, status))
      ++malformed_;
    else
      watch_.hear(from.source, status, time);
  } else {
    take_allocation(transfer);
  }
}

void DroneCanEscDrive::take_status(std::uint8_t source, const EscStatus& status, TimePoint time) {
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    const MotorConfig& motor = motors_[i];
    if (motor.index != status.esc_index) continue;
    if (motor.node_id != source) {
      ++counters_.foreign_status;
      continue;
    }
    DriveFeedback& feedback = feedback_[i];
    feedback.time = time;
    feedback.speed_rad_s =
        (motor.reversed ? -1 : 1) * status.rpm * kRadPerSPerRpm / motor.pole_pairs;
    feedback.current_a = status.current_a;
    feedback.voltage_v = status.voltage_v;
    feedback.temperature_k = status.temperature_k;
    feedback.error_count = status.error_count;
    has_status_[i] = true;
  }
}

void DroneCanEscDrive::take_allocation(const Transfer& transfer) {
  Allocation asked;
  if (!decode(transfer.payload, asked)) {
    ++malformed_;
  } else if (transfer.header.source == 0) {  // from others it is an allocator's answer
    ++counters_.allocation_requests;
    if (asked.is_first_part) last_allocation_ = asked.unique_id;
  }
}

// ---- frames out ---------------------------------------------------------------------------------

bool DroneCanEscDrive::Timer::is_due(TimePoint now) {
  if (was_set && now < next) return false;
  // On its own raster, so that a cycle's jitter does not add up; a missed turn is skipped.
  next = was_set && now - next < period ? next + period : now + period;
  was_set = true;
  return true;
}

TransferHeader DroneCanEscDrive::header(std::uint16_t type, std::uint8_t priority,
                                        std::uint8_t& transfer_id) const {
  const TransferHeader h = {
      .type_id = type, .priority = priority, .source = own_id_, .transfer_id = transfer_id};
  transfer_id = static_cast<std::uint8_t>((transfer_id + 1) % kTransferIds);
  return h;
}

int DroneCanEscDrive::send(std::span<const DriveSetpoint> setpoints, bool enable, TimePoint now,
                           std::span<CanFrame> out) {
  if (!has_started_) start_ = now;
  const bool is_change = !has_started_ || enable != is_enabled_;
  has_started_ = true;
  is_enabled_ = enable;
  watch_.set_enabled(enable);
  if (is_change) {
    changed_ = now;
    command_timer_.was_set = arming_timer_.was_set = false;
  }
  set_states(now);

  std::size_t n = 0;
  const auto rest = [&] { return out.subspan(n); };
  n += static_cast<std::size_t>(send_commands(setpoints, enable, now, rest()));
  n += static_cast<std::size_t>(send_arming(enable, now, rest()));
  n += static_cast<std::size_t>(send_heartbeat(now, rest()));
  n += static_cast<std::size_t>(send_answer(rest()));
  n += static_cast<std::size_t>(send_request(now, rest()));
  return static_cast<int>(n);
}

int DroneCanEscDrive::send_commands(std::span<const DriveSetpoint> setpoints, bool enable,
                                    TimePoint now, std::span<CanFrame> out) {
  const bool is_urgent = !enable && now - changed_ <= kUrgentStops;
  if (!command_timer_.is_due(now) && !is_urgent) return 0;
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    std::int16_t& command = command_.commands[motors_[i].index];
    command = range_.stop;
    const bool trips = watch_.has_tripped(static_cast<std::uint8_t>(motors_[i].node_id));
    if (!enable || trips) continue;
    if (i >= setpoints.size() || std::isnan(setpoints[i].value)) {
      ++counters_.bad_setpoints;
      continue;
    }
    const double scale = motors_[i].max_command * (motors_[i].reversed ? -1 : 1);
    command = command_of(range_, std::clamp(setpoints[i].value, -1.0, 1.0) * scale);
  }
  return to_frames(command_, header(RawCommand::kType.id, kCommandPriority, command_id_), out);
}

int DroneCanEscDrive::send_arming(bool enable, TimePoint now, std::span<CanFrame> out) {
  if (!sends_arming_ || !arming_timer_.is_due(now)) return 0;
  const ArmingStatus status = {enable ? ArmingStatus::kArmed : ArmingStatus::kDisarmed};
  return to_frames(status, header(ArmingStatus::kType.id, kStatusPriority, arming_id_), out);
}

int DroneCanEscDrive::send_heartbeat(TimePoint now, std::span<CanFrame> out) {
  own_info_.status.uptime_s = static_cast<std::uint32_t>(to_seconds(now - start_));
  if (!heartbeat_timer_.is_due(now)) return 0;
  return to_frames(own_info_.status, header(NodeStatus::kType.id, kStatusPriority, heartbeat_id_),
                   out);
}

int DroneCanEscDrive::send_answer(std::span<CanFrame> out) {
  if (clients_.empty()) return 0;
  const Client client = clients_[clients_.size() - 1];
  clients_.truncate(clients_.size() - 1);
  const TransferHeader h = {.kind = TransferKind::kResponse,
                            .type_id = NodeInfo::kType.id,
                            .priority = client.priority,
                            .source = own_id_,
                            .destination = client.node_id,
                            .transfer_id = client.transfer_id};
  return to_frames(own_info_, h, out);
}

int DroneCanEscDrive::send_request(TimePoint now, std::span<CanFrame> out) {
  const std::uint8_t node = out.empty() ? 0 : watch_.next_to_ask(now);
  if (node == 0) return 0;
  TransferHeader h = header(NodeInfo::kType.id, kServicePriority, request_ids_[node]);
  h.kind = TransferKind::kRequest;
  h.destination = node;
  return disassemble(h, NodeInfo::kType.signature, {}, out);
}

// ---- health -------------------------------------------------------------------------------------

bool DroneCanEscDrive::is_alive(int motor, TimePoint now) const {
  const auto i = static_cast<std::size_t>(motor);
  if (!watch_.is_alive(static_cast<std::uint8_t>(motors_[i].node_id), now)) return false;
  return !motors_[i].has_feedback ||
         (has_status_[i] && now - feedback_[i].time <= feedback_timeout_);
}

void DroneCanEscDrive::set_states(TimePoint now) {
  for (int i = 0; i < size(); ++i) {
    DriveFeedback& feedback = feedback_[static_cast<std::size_t>(i)];
    const auto node = static_cast<std::uint8_t>(motors_[static_cast<std::size_t>(i)].node_id);
    feedback.fault_code = watch_.fault_code(node);
    feedback.state = feedback.fault_code != 0 ? DriveState::kFault
                     : !is_alive(i, now)      ? DriveState::kUnknown
                     : is_enabled_            ? DriveState::kEnabled
                                              : DriveState::kDisabled;
  }
}

DriveGroupHealth DroneCanEscDrive::health(TimePoint now) const {
  DriveGroupHealth health = {.all_alive = true, .guards_itself = is_guarded_};
  // Two that command the same ESCs: what a motor does is nobody's will.
  if (counters_.own_id_conflicts > 0 && now - conflict_ <= kConflictTime) {
    health.any_fault = true;
    health.first_bad = 0;
    health.trouble = "another node on the bus has our node id";
    health.trouble_code = own_id_;
  }
  for (int i = 0; i < size(); ++i) {
    const auto node = static_cast<std::uint8_t>(motors_[static_cast<std::size_t>(i)].node_id);
    const bool alive = is_alive(i, now), faulty = watch_.is_faulty(node);
    health.all_alive = health.all_alive && alive;
    health.any_fault = health.any_fault || faulty;
    if (health.first_bad >= 0 || (alive && !faulty)) continue;
    health.first_bad = i;
    if (watch_.has_tripped(node)) health.trouble = "its node restarted while enabled";
  }
  if (!is_guarded_ && health.first_bad < 0) {
    health.first_bad = 0;
    health.trouble = "nobody has said that it stops by itself: drive.dronecan.esc_timeout_s";
  }
  return health;
}

}  // namespace gannet::hal
