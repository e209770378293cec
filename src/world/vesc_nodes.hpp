// VescNodes: the VESC controllers of a simulated vehicle, one for each motor. They take duty,
// speed, current and brake commands, stop by their own time-out, tell their status, and answer what
// is asked of them in a short packet. Bytes are written and read here from the firmware's facts,
// apart from the drive's codec. World's thread alone.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "src/world/motor_nodes.hpp"

namespace gannet::world {

struct VescBehaviour {
  double status_hz = 50;
  double timeout_s = 1;  // as in a new VESC; 0: never
};

class VescNodes final : public MotorNodes {
 public:
  VescNodes(const hal::DriveConfig& drives, const VescBehaviour& behaviour, std::uint64_t seed);

  int motors() const override { return static_cast<int>(nodes_.size()); }
  void report(int motor, const MotorReport& report) override { at(motor).report = report; }
  MotorFaults& faults(int motor) override { return at(motor).faults; }
  bool armed() const override { return armed_; }  // the newest command was not a stop
  std::span<const double> step(TimePoint now, std::span<const hal::CanFrame> in,
                               std::vector<hal::CanFrame>& out) override;

 private:
  struct Node {
    std::uint32_t id = 1;
    double sign = 1;
    int pole_pairs = 1;
    MotorReport report;
    MotorFaults faults;
    NodeMouth mouth;
    double throttle = 0;  // by the motor's sign
    TimePoint commanded = {}, next_status = {};
  };
  Node& at(int motor) { return nodes_[static_cast<std::size_t>(motor)]; }
  void hear(Node& node, const hal::CanFrame& frame, TimePoint now);
  void answer(Node& node, const hal::CanFrame& question, TimePoint now);
  void tell_status(Node& node, TimePoint now);
  bool has_timed_out(const Node& node, TimePoint now) const;
  void say(Node& node, std::uint32_t command, const std::array<std::uint8_t, 8>& data,
           TimePoint now);

  std::vector<Node> nodes_;
  const hal::VescConfig config_;
  const VescBehaviour behaviour_;
  std::vector<double> throttles_;
  Random random_;
  bool has_begun_ = false, armed_ = false;
};

}  // namespace gannet::world
