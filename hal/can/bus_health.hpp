// BusHealth: what a CAN controller's error frames say of the bus. Knows no socket.
//   good ⇄ warning (an error counter ≥ 96) ⇄ passive (≥ 128) → off (≥ 256) → good by a restart
// Only a restart, or the controller's word that it is active again, ends off. Error frames are
// laid out as linux/can/error.h says; a test compares with it. A value; servo thread; RT safe.
#pragma once

#include "hal/can/can_bus.hpp"

namespace gannet::hal {

class BusHealth {
 public:
  // frame.error is true. Counts in the counters what it tells.
  void take(const CanFrame& frame, CanCounters& counters);
  // The interface was brought up, or is found without (with) a carrier, which a controller gives
  // up when it goes off.
  void restart(bool has_carrier) { state_ = has_carrier ? BusState::kGood : BusState::kOff; }
  BusState state() const { return state_; }

 private:
  BusState state_ = BusState::kGood;
};

}  // namespace gannet::hal
