// Cia402Nodes: the CiA 402 drives of a simulated vehicle, one for each motor. A drive turns its
// motor at the velocity that it was told; the throttle given back is the one at which the plant's
// thruster runs at that speed. World's thread alone.
#pragma once

#include <span>
#include <vector>

#include "src/world/cia402_node.hpp"
#include "src/world/motor_nodes.hpp"

namespace gannet::world {

class Cia402Nodes final : public MotorNodes {
 public:
  Cia402Nodes(const hal::DriveConfig& drives, std::uint64_t seed);

  int motors() const override { return static_cast<int>(drives_.size()); }
  void report(int motor, const MotorReport& report) override;
  MotorFaults& faults(int motor) override { return at(motor).faults; }
  bool armed() const override { return armed_; }  // a control word said enable operation last
  std::span<const double> step(TimePoint now, std::span<const hal::CanFrame> in,
                               std::vector<hal::CanFrame>& out) override;

  Cia402Node& node(int motor) { return at(motor).node; }  // for tests

 private:
  struct Drive {
    Cia402Node node;
    std::uint32_t command_id;  // of the frames that bring its control word
    double units_per_rad_s;    // with the sign
    double increments_per_rad;
    MotorFaults faults;
    NodeMouth mouth;
  };
  Drive& at(int motor) { return drives_[static_cast<std::size_t>(motor)]; }
  void listen_for_arming(const hal::CanFrame& frame);

  std::vector<Drive> drives_;
  std::vector<double> throttles_;
  Random random_;
  bool has_begun_ = false, armed_ = false;
};

}  // namespace gannet::world
