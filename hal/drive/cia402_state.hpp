// The state machine of a CiA 402 drive: what its status word says, and the control word that leads
// on. Source: CiA 402-2 / IEC 61800-7-201, "State machine", tables of state coding and command
// coding; the numbers are those of the transitions.
//
//      0 ▶ NotReady ─1▶ SwitchOnDisabled ◀15── Fault ◀14─ FaultReaction ◀13─ any
//                          2▼  ▲7  ▲10  ▲9  ▲12
//                        Ready ┘   │    │   └── QuickStopActive
//                       3▼  ▲6     │    │             ▲11  │16
//                     SwitchedOn ──┘    │             │    ▼
//                       4▼  ▲5          │             │    │
//                     OperationEnabled ─┴─────────────┘◀───┘       (8: OperationEnabled ▶ Ready)
//
// Pure; values. RT safe.
#pragma once

#include <cstdint>

namespace gannet::hal::cia402 {

enum class State : std::uint8_t {
  kNotReady,
  kSwitchOnDisabled,
  kReady,
  kSwitchedOn,
  kOperationEnabled,
  kQuickStopActive,
  kFaultReaction,
  kFault,
  kUnknown,  // a status word that no state has
};
inline constexpr int kStates = 8;  // without kUnknown

State state_of(std::uint16_t status_word);
const char* to_string(State state);  // "switch on disabled" …

// Status word bits beside the state.
inline constexpr std::uint16_t kVoltageEnabled = 1 << 4, kWarning = 1 << 7, kRemote = 1 << 9,
                               kTargetReached = 1 << 10, kLimitActive = 1 << 11,
                               kModeSpecific12 = 1 << 12;  // pv: speed is 0; csv: obeys the target

// Control words.
inline constexpr std::uint16_t kDisableVoltage = 0x0000, kQuickStop = 0x0002, kShutdown = 0x0006,
                               kSwitchOn = 0x0007, kEnableOperation = 0x000F, kFaultReset = 0x0080,
                               kHaltBit = 0x0100;

enum class Goal : std::uint8_t {
  kOff,    // no voltage, at once: the motor coasts
  kStop,   // quick stop if it runs, then off
  kHalt,   // operation enabled, standing still
  kRun,    // operation enabled, obeying the target
  kReset,  // out of a fault; the caller gives it for a while, after another goal: an edge is needed
};

// The control word that takes one step towards the goal. A fault is left by kReset alone.
std::uint16_t next_control_word(State state, Goal goal);

}  // namespace gannet::hal::cia402
