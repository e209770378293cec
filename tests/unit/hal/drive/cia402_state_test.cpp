#include "hal/drive/cia402_state.hpp"

#include <gtest/gtest.h>

#include <string>

namespace gannet::hal::cia402 {
namespace {

// A machine written from the standard's transition table alone (IEC 61800-7-201, "PDS FSA"), to
// walk the control words through it. Quick stop ends by itself after some steps.
State follow(State state, std::uint16_t was, std::uint16_t word) {
  const auto matches = [&](std::uint16_t mask, std::uint16_t value) {
    return (word & mask) == value;
  };
  const bool shutdown = matches(0x87, 0x06), switch_on = matches(0x8F, 0x07),
             enable = matches(0x8F, 0x0F), no_voltage = matches(0x82, 0x00),
             quick_stop = matches(0x86, 0x02), reset = (word & 0x80) != 0 && (was & 0x80) == 0;
  switch (state) {
    case State::kNotReady:
      return State::kSwitchOnDisabled;
    case State::kSwitchOnDisabled:
      return shutdown ? State::kReady : state;
    case State::kReady:
      return no_voltage || quick_stop ? State::kSwitchOnDisabled
             : switch_on || enable    ? State::kSwitchedOn
                                      : state;
    case State::kSwitchedOn:
      return no_voltage || quick_stop ? State::kSwitchOnDisabled
             : shutdown               ? State::kReady
             : enable                 ? State::kOperationEnabled
                                      : state;
    case State::kOperationEnabled:
      return no_voltage   ? State::kSwitchOnDisabled
             : quick_stop ? State::kQuickStopActive
             : shutdown   ? State::kReady
             : switch_on  ? State::kSwitchedOn
                          : state;
    case State::kQuickStopActive:
      return no_voltage ? State::kSwitchOnDisabled : enable ? State::kOperationEnabled : state;
    case State::kFaultReaction:
      return State::kFault;
    case State::kFault:
      return reset ? State::kSwitchOnDisabled : state;
    case State::kUnknown:
      return state;
  }
  return state;
}

State reached(State state, Goal goal, int steps) {
  std::uint16_t was = 0;
  for (int i = 0; i < steps; ++i) {
    const std::uint16_t word = next_control_word(state, goal);
    state = follow(state, was, word);
    was = word;
  }
  return state;
}

TEST(Cia402State, IsThatOfTheStatusWordWhateverTheOtherBitsSay) {
  struct Row {
    const char* bits;  // 6543210 of the status word, x: either
    State state;
  };
  const Row rows[] = {
      {"0xx0000", State::kNotReady},
      {"1xx0000", State::kSwitchOnDisabled},
      {"01x0001", State::kReady},
      {"01x0011", State::kSwitchedOn},
      {"01x0111", State::kOperationEnabled},
      {"00x0111", State::kQuickStopActive},
      {"0xx1111", State::kFaultReaction},
      {"0xx1000", State::kFault},
  };
  int known = 0;
  for (int word = 0; word < 0x10000; ++word) {
    State expected = State::kUnknown;
    for (const Row& row : rows) {
      bool fits = true;
      for (int bit = 0; bit < 7; ++bit) {
        const char wanted = row.bits[6 - bit];
        fits = fits && (wanted == 'x' || (word >> bit & 1) == wanted - '0');
      }
      if (fits) expected = row.state;
    }
    ASSERT_EQ(state_of(static_cast<std::uint16_t>(word)), expected) << word;
    known += expected != State::kUnknown;
  }
  EXPECT_EQ(known, 0x10000 / 128 * 24);  // 4 states of 4 combinations, 4 of 2
}

TEST(Cia402State, OfStatusWordsSeenOnRealDrives) {
  EXPECT_EQ(state_of(0x0250), State::kSwitchOnDisabled);
  EXPECT_EQ(state_of(0x0231), State::kReady);
  EXPECT_EQ(state_of(0x0233), State::kSwitchedOn);
  EXPECT_EQ(state_of(0x1637), State::kOperationEnabled);
  EXPECT_EQ(state_of(0x0217), State::kQuickStopActive);
  EXPECT_EQ(state_of(0x0218), State::kFault);
}

TEST(Cia402State, HasTheControlWordOfTheTableForEveryStateAndGoal) {
  struct Row {
    State state;
    std::uint16_t off, stop, halt, run, reset;
  };
  const Row rows[] = {
      {State::kNotReady, 0, 0, 0, 0, 0},
      {State::kSwitchOnDisabled, 0, 0, 0x0006, 0x0006, 0},
      {State::kReady, 0, 0, 0x0007, 0x0007, 0},
      {State::kSwitchedOn, 0, 0, 0x010F, 0x000F, 0},
      {State::kOperationEnabled, 0, 0x0002, 0x010F, 0x000F, 0},
      {State::kQuickStopActive, 0, 0x0002, 0, 0, 0},
      {State::kFaultReaction, 0, 0, 0, 0, 0},
      {State::kFault, 0, 0, 0, 0, 0x0080},
      {State::kUnknown, 0, 0x0002, 0, 0, 0},
  };
  for (const Row& row : rows) {
    EXPECT_EQ(next_control_word(row.state, Goal::kOff), row.off) << to_string(row.state);
    EXPECT_EQ(next_control_word(row.state, Goal::kStop), row.stop) << to_string(row.state);
    EXPECT_EQ(next_control_word(row.state, Goal::kHalt), row.halt) << to_string(row.state);
    EXPECT_EQ(next_control_word(row.state, Goal::kRun), row.run) << to_string(row.state);
    EXPECT_EQ(next_control_word(row.state, Goal::kReset), row.reset) << to_string(row.state);
  }
}

TEST(Cia402State, LeadsFromEveryStateButFaultToOperationInAtMostFourSteps) {
  for (int i = 0; i < kStates; ++i) {
    const auto from = static_cast<State>(i);
    const bool is_fault = from == State::kFault || from == State::kFaultReaction;
    EXPECT_EQ(reached(from, Goal::kRun, 4), is_fault ? State::kFault : State::kOperationEnabled);
    EXPECT_EQ(reached(from, Goal::kHalt, 4), is_fault ? State::kFault : State::kOperationEnabled);
  }
}

TEST(Cia402State, LeadsOffFromEveryStateButFaultInOneStep) {
  for (int i = 0; i < kStates; ++i) {
    const auto from = static_cast<State>(i);
    const bool is_fault = from == State::kFault || from == State::kFaultReaction;
    EXPECT_EQ(reached(from, Goal::kOff, 1), is_fault ? State::kFault : State::kSwitchOnDisabled);
  }
}

TEST(Cia402State, StopsByQuickStopAndStaysThere) {
  EXPECT_EQ(reached(State::kOperationEnabled, Goal::kStop, 9), State::kQuickStopActive);
  EXPECT_EQ(reached(State::kSwitchedOn, Goal::kStop, 1), State::kSwitchOnDisabled);
}

TEST(Cia402State, LeavesAFaultByResetAlone) {
  for (const Goal goal : {Goal::kOff, Goal::kStop, Goal::kHalt, Goal::kRun}) {
    EXPECT_EQ(reached(State::kFault, goal, 9), State::kFault);
  }
  EXPECT_EQ(reached(State::kFault, Goal::kReset, 1), State::kSwitchOnDisabled);
  EXPECT_EQ(reached(State::kFault, Goal::kReset, 9), State::kSwitchOnDisabled);  // and no further
}

TEST(Cia402State, HasANameEach) {
  for (int i = 0; i <= kStates; ++i) {
    for (int j = 0; j < i; ++j) {
      EXPECT_STRNE(to_string(static_cast<State>(i)), to_string(static_cast<State>(j)));
    }
  }
  EXPECT_STREQ(to_string(State::kOperationEnabled), "operation enabled");
}

}  // namespace
}  // namespace gannet::hal::cia402
