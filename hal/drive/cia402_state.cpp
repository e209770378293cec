#include "hal/drive/cia402_state.hpp"

namespace gannet::hal::cia402 {
namespace {

// Bits 6, 5, 3, 2, 1, 0 tell the state; bit 5 (quick stop, active low) counts only in some.
struct Coding {
  State state;
  std::uint16_t mask, value;
  const char* name;
};
constexpr Coding kCodings[kStates] = {
    {State::kNotReady, 0x4F, 0x00, "not ready to switch on"},
    {State::kSwitchOnDisabled, 0x4F, 0x40, "switch on disabled"},
    {State::kReady, 0x6F, 0x21, "ready to switch on"},
    {State::kSwitchedOn, 0x6F, 0x23, "switched on"},
    {State::kOperationEnabled, 0x6F, 0x27, "operation enabled"},
    {State::kQuickStopActive, 0x6F, 0x07, "quick stop active"},
    {State::kFaultReaction, 0x4F, 0x0F, "fault reaction active"},
    {State::kFault, 0x4F, 0x08, "fault"},
};

std::uint16_t towards_operation(State state, Goal goal) {
  switch (state) {
    case State::kSwitchOnDisabled:
      return kShutdown;  // 2
    case State::kReady:
      return kSwitchOn;  // 3
    case State::kSwitchedOn:
    case State::kOperationEnabled:  // 4, or stay
      return goal == Goal::kHalt ? kEnableOperation | kHaltBit : kEnableOperation;
    case State::kQuickStopActive:  // 12: 16 is optional, and would run on from within a stop
    case State::kNotReady:
    case State::kFaultReaction:
    case State::kFault:
    case State::kUnknown:
      return kDisableVoltage;
  }
  return kDisableVoltage;
}

}  // namespace

State state_of(std::uint16_t status_word) {
  for (const Coding& coding : kCodings) {
    if ((status_word & coding.mask) == coding.value) return coding.state;
  }
  return State::kUnknown;
}

const char* to_string(State state) {
  return state == State::kUnknown ? "unknown" : kCodings[static_cast<int>(state)].name;
}

std::uint16_t next_control_word(State state, Goal goal) {
  switch (goal) {
    case Goal::kOff:
      return kDisableVoltage;
    case Goal::kStop:  // an unknown state may be one that turns
      return state == State::kOperationEnabled || state == State::kQuickStopActive ||
                     state == State::kUnknown
                 ? kQuickStop
                 : kDisableVoltage;
    case Goal::kHalt:
    case Goal::kRun:
      return towards_operation(state, goal);
    case Goal::kReset:
      return state == State::kFault ? kFaultReset : kDisableVoltage;
  }
  return kDisableVoltage;
}

}  // namespace gannet::hal::cia402
