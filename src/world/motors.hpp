// Motors: what hangs on the simulated bus: the hub that the daemon connects to, the motor nodes
// of the vehicle behind a delay. World's thread alone.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hal/can/local_bus.hpp"
#include "hal/drive/drive_config.hpp"
#include "src/world/motor_nodes.hpp"
#include "src/world/rov_plant.hpp"

namespace gannet::world {

class Motors {
 public:
  // delay: from a frame on the bus to the node that hears it. Error: the bus's name is in use, or
  // nothing here speaks drive.kind.
  static Result<std::unique_ptr<Motors>> create(const std::string& bus,
                                                const hal::DriveConfig& drives, Duration delay,
                                                std::uint64_t seed);

  // Takes what came by now, lets the nodes obey what is due, puts their throttles on the plant and
  // their answers on the bus.
  void step(TimePoint now, RovPlant& plant);

  // Throttles −1 … 1 as the nodes obey them, by the vehicle's sign.
  std::span<const double> throttles() const { return throttles_; }
  bool armed() const { return nodes_->armed(); }
  bool connected() const { return hub_->nodes() > 0; }
  MotorFaults& faults(int motor) { return nodes_->faults(motor); }
  int count() const { return nodes_->motors(); }
  std::uint64_t frames_heard() const { return hub_->counters().received; }

 private:
  struct Delayed {
    TimePoint due;
    hal::CanFrame frame;
  };
  Motors(std::unique_ptr<hal::LocalCanHub> hub, std::unique_ptr<MotorNodes> nodes, Duration delay);
  void receive(TimePoint now);
  void report(const RovPlant& plant);

  std::unique_ptr<hal::LocalCanHub> hub_;
  std::unique_ptr<MotorNodes> nodes_;
  const Duration delay_;
  std::deque<Delayed> delayed_;
  std::vector<hal::CanFrame> heard_, said_;  // of one step
  std::vector<double> throttles_;
};

}  // namespace gannet::world
