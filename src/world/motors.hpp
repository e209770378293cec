// Motors: what hangs on the simulated vehicle's bus: the motor nodes behind a delay. Nodes obey
// each frame at its own time on the bus plus the delay, also when several came between two steps.
// World's thread alone.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "hal/drive/drive_config.hpp"
#include "src/world/can_end.hpp"
#include "src/world/motor_nodes.hpp"
#include "src/world/plant.hpp"

namespace gannet::world {

// From then on the drives turn (one is told to), or are still (none is, and they are disarmed or
// left alone by the bus): the time on the bus of the frame that told them, or of the nodes' own
// decision when commands stay away.
struct Turn {
  TimePoint time;
  bool still;
};

class Motors {
 public:
  // delay: from a frame on the bus to the node that hears it. Error: nothing here speaks
  // drive.kind.
  static Result<std::unique_ptr<Motors>> create(std::unique_ptr<CanEnd> bus,
                                                const hal::DriveConfig& drives, Duration delay,
                                                std::uint64_t seed);

  // Takes what came by now, lets the nodes obey what is due, puts their throttles on the plant and
  // their answers on the bus.
  void step(TimePoint now, Plant& plant);

  // Throttles −1 … 1 as the nodes obey them, by the vehicle's sign.
  std::span<const double> throttles() const { return throttles_; }
  bool armed() const { return nodes_->armed(); }
  CanEnd& bus() { return *bus_; }
  MotorFaults& faults(int motor) { return nodes_->faults(motor); }
  int count() const { return nodes_->motors(); }
  const std::vector<Turn>& turns() const { return turns_; }  // since the beginning

 private:
  struct Delayed {
    TimePoint due;
    hal::CanFrame frame;
  };
  Motors(std::unique_ptr<CanEnd> bus, std::unique_ptr<MotorNodes> nodes, Duration delay);
  void receive(TimePoint now);
  void obey(TimePoint due, TimePoint told);
  void report(const Plant& plant);

  std::unique_ptr<CanEnd> bus_;
  std::unique_ptr<MotorNodes> nodes_;
  const Duration delay_;
  TimePoint last_step_ = {};
  TimePoint last_heard_ = {};  // frame
  std::deque<Delayed> delayed_;
  std::vector<hal::CanFrame> heard_, said_;  // of one step
  std::vector<double> throttles_;
  std::vector<Turn> turns_;
};

}  // namespace gannet::world
