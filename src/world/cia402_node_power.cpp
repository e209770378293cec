// The drive's side: the state machine and its ramps.
#include <algorithm>
#include <cmath>

#include "src/world/cia402_node.hpp"

namespace gannet::world {

namespace {

constexpr int kProfileVelocity = 3, kCyclicVelocity = 9;

double towards(double from, double to, double most) {
  return from < to ? std::min(to, from + most) : std::max(to, from - most);
}

}  // namespace

// One transition for one control word; the numbers are the standard's.
void Cia402Node::obey(std::uint16_t word) {
  const bool b0 = (word & 1) != 0, b1 = (word & 2) != 0, b2 = (word & 4) != 0, b3 = (word & 8) != 0;
  const bool b7 = (word & 0x80) != 0, b7_was = (control_ & 0x80) != 0;
  control_ = word;
  if (power_ == Power::kFault && b7 && !b7_was && fault_ == 0 && !is_comm_error_) {  // 15
    power_ = Power::kSwitchOnDisabled;
    set(0x603F, 0, 0);
    say_emergency(0);
    return;
  }
  if (b7) return;
  const bool is_live = power_ == Power::kReadyToSwitchOn || power_ == Power::kSwitchedOn ||
                       power_ == Power::kOperationEnabled || power_ == Power::kQuickStopActive;
  if (!b1) {  // disable voltage: 7, 9, 10, 12
    if (is_live) power_ = Power::kSwitchOnDisabled;
  } else if (!b2) {  // quick stop: 7, 10, 11
    if (power_ == Power::kOperationEnabled) {
      power_ = Power::kQuickStopActive;
    } else if (is_live && power_ != Power::kQuickStopActive) {
      power_ = Power::kSwitchOnDisabled;
    }
  } else if (!b0) {  // shutdown: 2, 6, 8
    const bool can = power_ == Power::kSwitchOnDisabled || power_ == Power::kSwitchedOn ||
                     power_ == Power::kOperationEnabled;
    if (can) power_ = Power::kReadyToSwitchOn;
  } else if (power_ == Power::kReadyToSwitchOn) {  // 3
    power_ = Power::kSwitchedOn;
  } else if (!b3) {  // disable operation: 5
    if (power_ == Power::kOperationEnabled) power_ = Power::kSwitchedOn;
  } else if (power_ == Power::kSwitchedOn) {  // 4
    power_ = Power::kOperationEnabled;
  } else if (power_ == Power::kQuickStopActive && get_signed(0x605A) >= 5) {  // 16
    power_ = Power::kOperationEnabled;
  }
}

void Cia402Node::react_to_loss() {
  switch (get_signed(0x6007)) {
    case 2:
      obey(0x0000);
      break;
    case 3:
      obey(0x0002);
      break;
    default:
      break;  // 0: nothing; 1: the pending fault
  }
}

void Cia402Node::pass_by_itself() {
  if (fault_ != 0) pending_fault_ = fault_;
  const bool is_faulty = power_ == Power::kFault || power_ == Power::kFaultReactionActive;
  if (pending_fault_ != 0 && !is_faulty) {  // 13
    const bool turns = power_ == Power::kOperationEnabled || power_ == Power::kQuickStopActive;
    power_ = Power::kFaultReactionActive;
    if (!turns || get_signed(0x605E) == 0) demand_ = 0;
    set(0x603F, 0, pending_fault_);
    if (!is_comm_error_) say_emergency(pending_fault_);                // that one has been said
  } else if (power_ == Power::kFaultReactionActive && demand_ == 0) {  // 14
    power_ = Power::kFault;
  } else if (power_ == Power::kNotReadyToSwitchOn) {  // 1
    power_ = Power::kSwitchOnDisabled;
  } else if (power_ == Power::kQuickStopActive && get_signed(0x605A) < 5 &&
             (demand_ == 0 || get_signed(0x605A) == 0)) {  // 12
    power_ = Power::kSwitchOnDisabled;
  }
  pending_fault_ = 0;
}

void Cia402Node::ramp(double dt_s) {
  const double accelerate = get(0x6083) * dt_s, slow_down = get(0x6084) * dt_s,
               quick_stop = get(0x6085) * dt_s;
  switch (power_) {
    case Power::kOperationEnabled: {
      const int mode = get_signed(0x6061);
      const bool is_halted = (control_ & 0x100) != 0 && mode == kProfileVelocity;
      const double target = is_halted || !has_profile() ? 0 : get_signed(0x60FF);
      if (mode == kCyclicVelocity) {
        demand_ = target;
      } else {
        const bool is_faster = target * demand_ >= 0 && std::fabs(target) > std::fabs(demand_);
        const double stop = get_signed(0x605D) == 2 ? quick_stop : slow_down;
        demand_ = towards(demand_, target, is_halted ? stop : is_faster ? accelerate : slow_down);
      }
      break;
    }
    case Power::kQuickStopActive: {
      const int option = get_signed(0x605A);
      demand_ = towards(demand_, 0, option == 1 || option == 5 ? slow_down : quick_stop);
      break;
    }
    case Power::kFaultReactionActive:
      demand_ = towards(demand_, 0, get_signed(0x605E) == 1 ? slow_down : quick_stop);
      break;
    default:
      demand_ = 0;  // no torque: it coasts
  }
}

bool Cia402Node::has_profile() const {
  const int mode = get_signed(0x6061);
  return mode == kProfileVelocity || mode == kCyclicVelocity;
}

std::uint16_t Cia402Node::status_word() const {
  int word = 0x0200;  // remote: it obeys the bus
  switch (power_) {
    case Power::kNotReadyToSwitchOn:
      break;
    case Power::kSwitchOnDisabled:
      word |= 0x0040;
      break;
    case Power::kReadyToSwitchOn:
      word |= 0x0021;
      break;
    case Power::kSwitchedOn:
      word |= 0x0033;
      break;
    case Power::kOperationEnabled:
      word |= 0x0037;
      break;
    case Power::kQuickStopActive:
      word |= 0x0017;
      break;
    case Power::kFaultReactionActive:
      word |= 0x001F;
      break;
    case Power::kFault:
      word |= 0x0008;
      break;
  }
  if (power_ != Power::kOperationEnabled) return static_cast<std::uint16_t>(word);
  const int mode = get_signed(0x6061);
  if (mode == kCyclicVelocity) word |= 0x1000;  // follows the target
  if (mode == kProfileVelocity) {
    if (demand_ == get_signed(0x60FF)) word |= 0x0400;
    if (std::fabs(velocity_) < 1) word |= 0x1000;  // stands still
  }
  return static_cast<std::uint16_t>(word);
}

}  // namespace gannet::world
