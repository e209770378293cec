// OdriveNodes: the ODrive axes of a simulated vehicle, one for each motor, over CANSimple: axis
// states, velocity control, errors that stay until they are cleared, the watchdog that any frame
// feeds, and the messages that come by themselves. Bytes are written and read here from ODrive's
// documentation, apart from the drive's codec. World's thread alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "src/world/motor_nodes.hpp"

namespace gannet::world {

struct OdriveBehaviour {
  double heartbeat_hz = 10;
  double encoder_hz = 100;
  double others_hz = 10;    // currents, bus voltage, temperatures
  double watchdog_s = 0.5;  // 0: not enabled
};

class OdriveNodes final : public MotorNodes {
 public:
  OdriveNodes(const hal::DriveConfig& drives, const OdriveBehaviour& behaviour, std::uint64_t seed);

  int motors() const override { return static_cast<int>(nodes_.size()); }
  void report(int motor, const MotorReport& report) override { at(motor).report = report; }
  MotorFaults& faults(int motor) override { return at(motor).faults; }
  bool armed() const override { return armed_; }  // closed loop was asked for last
  std::span<const double> step(TimePoint now, std::span<const hal::CanFrame> in,
                               std::vector<hal::CanFrame>& out) override;

 private:
  struct Node {
    std::uint32_t id = 1;
    double sign = 1;
    MotorReport report;
    MotorFaults faults;
    NodeMouth mouth;
    std::uint8_t state = 1;  // idle
    std::uint32_t error = 0, control_mode = 3;
    double velocity = 0;  // turns/s, as commanded
    TimePoint fed = {}, next_heartbeat = {}, next_encoder = {}, next_others = {};
  };
  Node& at(int motor) { return nodes_[static_cast<std::size_t>(motor)]; }
  void begin(TimePoint now);
  void hear(Node& node, const hal::CanFrame& frame, TimePoint now);
  void raise(Node& node, std::uint32_t error);
  void speak(Node& node, TimePoint now);
  void say(Node& node, std::uint32_t command, double first, double second, TimePoint now);

  std::vector<Node> nodes_;
  const OdriveBehaviour behaviour_;
  const std::uint32_t watchdog_error_;
  std::vector<double> throttles_;
  Random random_;
  bool has_begun_ = false, armed_ = false;
};

}  // namespace gannet::world
