// Motors: what hangs on the simulated bus: the hub that the daemon connects to, the ESC nodes of
// the vehicle behind a delay, and an ear for what the bus says of arming. World's thread alone.
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
#include "hal/drive/dronecan_transfer.hpp"
#include "src/world/esc_node.hpp"
#include "src/world/rov_plant.hpp"

namespace gannet::world {

class Motors {
 public:
  // delay: from a frame on the bus to the node that hears it. Error: the bus's name is in use.
  static Result<std::unique_ptr<Motors>> create(const std::string& bus,
                                                const hal::DriveConfig& drives, Duration delay,
                                                std::uint64_t seed);

  // Takes what came by now, lets the nodes obey what is due, puts their throttles on the plant and
  // their answers on the bus.
  void step(TimePoint now, RovPlant& plant);

  // Throttles −1 … 1 as the nodes obey them, by the vehicle's sign.
  std::span<const double> throttles() const { return throttles_; }
  bool armed() const { return armed_; }  // as the bus said last
  bool connected() const { return hub_->nodes() > 0; }
  EscFaults& faults(int motor) { return nodes_.faults(motor); }
  int count() const { return nodes_.motors(); }
  std::uint64_t frames_heard() const { return hub_->counters().received; }

 private:
  struct Delayed {
    TimePoint due;
    hal::CanFrame frame;
  };
  Motors(std::unique_ptr<hal::LocalCanHub> hub, const hal::DriveConfig& drives, Duration delay,
         std::uint64_t seed);
  void receive(TimePoint now);
  void listen_for_arming(const hal::CanFrame& frame, TimePoint now);
  void report(const RovPlant& plant);

  std::unique_ptr<hal::LocalCanHub> hub_;
  EscNodes nodes_;
  const Duration delay_;
  hal::dronecan::TransferReceiver ear_;
  std::deque<Delayed> delayed_;
  std::vector<hal::CanFrame> heard_, said_;  // of one step
  std::vector<double> throttles_;
  bool armed_ = false;
};

}  // namespace gannet::world
