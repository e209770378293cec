// EscNodes: the DroneCAN nodes of a simulated vehicle: they take RawCommand, report status,
// heartbeat and who they are, and stop by themselves when commands stay away, as real ESCs do.
// Message descriptions, ranges and the list of motors are the drive's own. Pure: frames and time
// in, frames and thrust fractions out; the same seed gives the same frames. World's thread alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hal/drive/drive_config.hpp"
#include "hal/drive/dronecan_messages.hpp"
#include "hal/drive/esc_range.hpp"
#include "src/world/motor_nodes.hpp"

namespace gannet::world {

struct EscBehaviour {
  double status_hz = 20;
  double command_timeout_s = 0.5;
  bool needs_arming = false;  // turns nothing before ArmingStatus says armed
};

class EscNodes final : public MotorNodes {
 public:
  // Motors with the same node id share a node, as PWM ESCs do.
  EscNodes(const hal::DriveConfig& drives, const EscBehaviour& behaviour, std::uint64_t seed);

  int motors() const override { return static_cast<int>(motors_.size()); }
  void report(int motor, const MotorReport& report) override { reports_[at(motor)] = report; }
  MotorFaults& faults(int motor) override { return nodes_[node_of_[at(motor)]].faults; }
  bool armed() const override { return armed_; }  // as ArmingStatus said last
  std::span<const double> step(TimePoint now, std::span<const hal::CanFrame> in,
                               std::vector<hal::CanFrame>& out) override;

 private:
  struct Node {
    Node(std::uint8_t id, Duration phase);
    std::uint8_t id;
    Duration phase;  // nodes do not all speak at once
    hal::dronecan::TransferReceiver receiver;
    std::vector<std::size_t> motors;
    MotorFaults faults;
    bool was_faulty = false;
    std::uint32_t error_count = 0;
    bool is_commanded = false, is_armed = false;
    TimePoint command_time = {}, next_heartbeat = {}, next_status = {};
    std::uint8_t heartbeat_id = 0, status_id = 0;
    NodeMouth mouth;
  };
  static std::size_t at(int motor) { return static_cast<std::size_t>(motor); }

  void begin(TimePoint now);
  void listen_for_arming(const hal::CanFrame& frame, TimePoint now);
  void hear(Node& node, const hal::CanFrame& frame, TimePoint now);
  void obey(Node& node, const hal::dronecan::RawCommand& command, TimePoint now);
  void speak(Node& node, TimePoint now);
  void say_status(Node& node, std::size_t motor, TimePoint now);
  void say_info(Node& node, const hal::dronecan::TransferHeader& request, TimePoint now);
  hal::dronecan::NodeStatus status_of(const Node& node, TimePoint now) const;
  template <class Message>
  void say(Node& node, const Message& message, const hal::dronecan::TransferHeader& header,
           TimePoint now);
  bool turns(const Node& node, TimePoint now) const;

  std::vector<hal::MotorConfig> motors_;
  hal::EscRange range_;
  EscBehaviour behaviour_;
  std::vector<Node> nodes_;
  std::vector<std::size_t> node_of_;  // by motor
  std::vector<MotorReport> reports_;
  std::vector<double> asked_;      // the newest command's fractions
  std::vector<double> commanded_;  // what is turned
  Random random_;
  hal::dronecan::TransferReceiver ear_;  // hears also what silent nodes don't
  bool armed_ = false;
  bool has_begun_ = false;
  TimePoint start_ = {};
};

}  // namespace gannet::world
