// DroneCanEscDrive: motors behind DroneCAN ESCs, or PWM ESCs behind a DroneCAN node, with static
// node ids. A setpoint is a thrust fraction −1 … 1, by the vehicle's sign; NaN stops.
//
// Out: RawCommand for all ESC indices in each call of send (or as command_period_s says), the
// range's stop for every motor while not enabled, in each call for the first 0.3 s; ArmingStatus
// twice a second and at a change; our NodeStatus once a second; GetNodeInfo asked of each motor's
// node and answered. In: esc.Status, NodeStatus, GetNodeInfo, and the Allocation requests of nodes
// that have no id: these are counted and shown, never granted.
//
// A node that restarts while enabled is faulty, and its motors are told to stop, until enable has
// been taken away.
// A frame of somebody else under our node id is a fault until 2 s have passed without one.
// That the ESCs stop by themselves when we die is known from the config alone
// (DroneCanConfig::is_guarded); without it arming is refused.
// A motor is alive when its node's heartbeat and, where it has feedback, its status are fresh.
// In feedback a value that the ESC does not know is NaN. Servo thread; RT safe after creation.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "hal/drive/drive.hpp"
#include "hal/drive/drive_config.hpp"
#include "hal/drive/dronecan_messages.hpp"
#include "hal/drive/dronecan_node_watch.hpp"
#include "hal/drive/esc_range.hpp"
#include "platform/base/fixed_vector.hpp"
#include "platform/base/result.hpp"

namespace gannet::hal {

struct DroneCanCounters {
  std::uint64_t allocation_requests = 0;  // a node without an id: give it a static one
  std::uint64_t own_id_conflicts = 0;     // frames of somebody else under our node id
  std::uint64_t foreign_status = 0;       // an ESC index reported by another node than configured
  std::uint64_t bad_setpoints = 0;        // NaN, or none for a motor, while enabled
};

class DroneCanEscDrive final : public DriveGroup {
 public:
  // Error: what in the config does not fit together.
  static Result<std::unique_ptr<DroneCanEscDrive>> create(const DriveConfig& config);

  int size() const override { return static_cast<int>(motors_.size()); }
  void receive(const CanFrame& frame, TimePoint time) override;
  int send(std::span<const DriveSetpoint> setpoints, bool enable, TimePoint now,
           std::span<CanFrame> out) override;
  int max_frames() const override;
  std::span<const DriveFeedback> feedback() const override { return feedback_; }
  DriveGroupHealth health(TimePoint now) const override;
  std::uint64_t malformed() const override { return malformed_ + receiver_.counters().malformed; }

  // For status and diagnosis, on the same thread.
  std::span<const dronecan::WatchedNode> nodes() const { return watch_.nodes(); }
  const DroneCanCounters& counters() const { return counters_; }
  const dronecan::TransferCounters& transfers() const { return receiver_.counters(); }
  // The unique id's first part of the newest node that asked for an id.
  std::span<const std::uint8_t> last_allocation_id() const { return last_allocation_.span(); }

  // What it listens to, for a bus's filters.
  static std::vector<CanFilter> wanted_frames(const DriveConfig& config);

 private:
  struct Client {  // who asked for our node info
    std::uint8_t node_id = 0, transfer_id = 0, priority = 0;
  };
  struct Timer {
    Duration period = {};
    TimePoint next = {};
    bool was_set = false;
    bool is_due(TimePoint now);
  };

  DroneCanEscDrive(const DriveConfig& config, const EscRange& range,
                   std::span<const std::uint8_t> node_ids);

  void take(const dronecan::Transfer& transfer, TimePoint time);
  void take_status(std::uint8_t source, const dronecan::EscStatus& status, TimePoint time);
  void take_allocation(const dronecan::Transfer& transfer);
  void set_states(TimePoint now);
  bool is_alive(int motor, TimePoint now) const;

  // Each writes what is due to the front of out and returns how many frames.
  int send_commands(std::span<const DriveSetpoint> setpoints, bool enable, TimePoint now,
                    std::span<CanFrame> out);
  int send_arming(bool enable, TimePoint now, std::span<CanFrame> out);
  int send_heartbeat(TimePoint now, std::span<CanFrame> out);
  int send_answer(std::span<CanFrame> out);
  int send_request(TimePoint now, std::span<CanFrame> out);
  dronecan::TransferHeader header(std::uint16_t type, std::uint8_t priority,
                                  std::uint8_t& transfer_id) const;

  const std::vector<MotorConfig> motors_;
  const EscRange range_;
  const std::uint8_t own_id_;
  const Duration feedback_timeout_;
  const bool sends_arming_;
  const bool is_guarded_;  // or the config accepts that they are not
  dronecan::RawCommand command_;
  dronecan::NodeInfo own_info_;

  dronecan::TransferReceiver receiver_;
  dronecan::NodeWatch watch_;
  std::vector<DriveFeedback> feedback_;
  std::vector<bool> has_status_;
  FixedVector<Client, 8> clients_;
  FixedVector<std::uint8_t, 16> last_allocation_;

  bool is_enabled_ = false;
  bool has_started_ = false;
  TimePoint conflict_ = {};              // the last frame of somebody else under our node id
  TimePoint start_ = {}, changed_ = {};  // the first cycle; enable was given or taken away
  Timer command_timer_, arming_timer_, heartbeat_timer_;
  std::uint8_t command_id_ = 0, arming_id_ = 0, heartbeat_id_ = 0;
  std::array<std::uint8_t, dronecan::kMaxNodeId + 1> request_ids_ = {};
  DroneCanCounters counters_;
  std::uint64_t malformed_ = 0;
};

}  // namespace gannet::hal
