// MotorNodes: the motor nodes that hang on a simulated vehicle's bus, whatever they speak: frames
// and time in, frames and throttles out. They obey, report, and stop by themselves when commands
// stay away, as real ones do. Kinds by drive.kind, in motor_nodes.cpp. Pure: the same seed gives
// the same frames. World's thread alone.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "hal/can/can_frame.hpp"
#include "hal/drive/drive_config.hpp"
#include "platform/base/random.hpp"
#include "platform/base/result.hpp"
#include "platform/base/time.hpp"

namespace gannet::world {

// What the plant makes of a motor, by the vehicle's sign.
struct MotorReport {
  double speed_rad_s = 0;
  double current_a = 0;
  double voltage_v = 0;
  double temperature_k = 293;
  double position_rad = 0;  // over all turns
};

struct MotorFaults {
  bool silent = false;  // off the bus: it neither speaks nor hears
  bool faulty = false;  // says that it is broken, and stands still
  Duration late = {};   // what it says arrives so much later
  double garbage = 0;   // this share of its frames has random bytes
};

class MotorNodes {
 public:
  virtual ~MotorNodes() = default;

  virtual int motors() const = 0;
  virtual void report(int motor, const MotorReport& report) = 0;
  // Of the node that this motor hangs on.
  virtual MotorFaults& faults(int motor) = 0;
  // They have been told that they may turn, by whatever the protocol has for that.
  virtual bool armed() const = 0;

  // Takes the frames that came, adds to out what the nodes send now. Returns the throttle −1 … 1
  // of each motor as its node obeys it, by the vehicle's sign; valid until the next call.
  virtual std::span<const double> step(TimePoint now, std::span<const hal::CanFrame> in,
                                       std::vector<hal::CanFrame>& out) = 0;
};

// Error: drive.kind has no nodes here.
Result<std::unique_ptr<MotorNodes>> make_motor_nodes(const hal::DriveConfig& drives,
                                                     std::uint64_t seed);

// What a node has said and the bus has not heard yet: late and garbled as its faults say.
class NodeMouth {
 public:
  void say(hal::CanFrame frame, const MotorFaults& faults, Random& random, TimePoint now);
  // In the order they were said, also when the delay has just become shorter.
  void deliver(const MotorFaults& faults, TimePoint now, std::vector<hal::CanFrame>& out);

 private:
  struct Waiting {
    TimePoint due;
    hal::CanFrame frame;
  };
  std::deque<Waiting> waiting_;
};

}  // namespace gannet::world
