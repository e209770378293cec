#include "src/safety/estop_input.hpp"

#include <gtest/gtest.h>

namespace gannet::safety {
namespace {

constexpr Line kOut = Line::kInactive, kIn = Line::kActive, kNot = Line::kUnknown;
using Channel = EstopInput::Channel;

// Cycles of 5 ms, release debounced for 50 ms, discrepancy after 100 ms.
class EstopInputTest : public testing::Test {
 protected:
  static SafetyConfig config() {
    SafetyConfig config;
    config.estop_release_s = 0.05;
    config.estop_discrepancy_s = 0.1;
    return config;
  }
  Line one(Channel channel) { return sut_.step(channel, now_ += kCycle); }
  Line one(Line line) { return one(Channel{.line = line}); }
  Line two(Line first, Line second) {
    return sut_.step({.line = first}, {.line = second}, now_ += kCycle);
  }
  // Cycles until the line is inactive; −1: not within a second.
  template <class Step>
  int cycles_until_inactive(Step step) {
    for (int cycle = 1; cycle <= 200; ++cycle) {
      if (step() == kOut) return cycle;
    }
    return -1;
  }

  static constexpr Duration kCycle = std::chrono::milliseconds(5);
  TimePoint now_ = time_from_ns(1'000'000'000);
  EstopInput sut_{config()};
};

TEST_F(EstopInputTest, IsInactiveFromTheFirstCycleWhenNobodyPresses) {
  EXPECT_EQ(one(kOut), kOut);
  EXPECT_EQ(sut_.presses(), 0u);
}

TEST_F(EstopInputTest, PressingActsInTheSameCycle) {
  one(kOut);
  EXPECT_EQ(one(kIn), kIn);
  EXPECT_EQ(sut_.presses(), 1u);
}

TEST_F(EstopInputTest, AnEdgeBetweenTwoCyclesIsAPress) {
  one(kOut);
  EXPECT_EQ(one({.line = kOut, .pressed = true, .released = true}), kIn);
  EXPECT_EQ(sut_.presses(), 1u);
}

TEST_F(EstopInputTest, ReleaseIsDebounced) {
  one(kIn);
  EXPECT_EQ(cycles_until_inactive([&] { return one(kOut); }), 10);
}

TEST_F(EstopInputTest, EveryBounceBeginsTheReleaseAnew) {
  one(kIn);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(one(kOut), kIn);
  EXPECT_EQ(one({.line = kOut, .released = true}), kIn);  // the press before it was lost
  for (int i = 0; i < 9; ++i) EXPECT_EQ(one(kOut), kIn);
  EXPECT_EQ(one({.line = kOut, .pressed = true}), kIn);
  EXPECT_EQ(cycles_until_inactive([&] { return one(kOut); }), 10);
  EXPECT_EQ(sut_.presses(), 1u) << "bounces are one press";
}

TEST_F(EstopInputTest, WithoutDebouncingTheReleaseActsAtOnceToo) {
  SafetyConfig at_once = config();
  at_once.estop_release_s = 0;
  sut_ = EstopInput(at_once);
  EXPECT_EQ(one(kIn), kIn);
  EXPECT_EQ(one(kOut), kOut);
}

TEST_F(EstopInputTest, AnEdgeToInactiveAloneIsNoPress) {
  one(kOut);
  EXPECT_EQ(one({.line = kOut, .released = true}), kOut);
}

TEST_F(EstopInputTest, ALineThatCannotBeReadIsUnknownAndItsReturnIsDebounced) {
  one(kOut);
  EXPECT_EQ(one(kNot), kNot);
  EXPECT_EQ(one({.line = kNot, .pressed = true}), kIn);
  EXPECT_EQ(cycles_until_inactive([&] { return one(kOut); }), 10);
  sut_ = EstopInput(config());
  EXPECT_EQ(one(kNot), kNot);
}

TEST_F(EstopInputTest, EitherOfTwoChannelsStopsAtOnce) {
  two(kOut, kOut);
  EXPECT_EQ(two(kIn, kOut), kIn);
  sut_ = EstopInput(config());
  EXPECT_EQ(two(kOut, kIn), kIn);
  sut_ = EstopInput(config());
  EXPECT_EQ(two(kOut, kNot), kNot);
  EXPECT_EQ(two(kIn, kNot), kIn) << "a press counts, whatever the other one is";
}

TEST_F(EstopInputTest, ContactsMayDifferWhileTheButtonMoves) {
  two(kOut, kOut);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(two(kIn, kOut), kIn);
  two(kIn, kIn);
  for (int i = 0; i < 20; ++i) two(kOut, kIn);
  EXPECT_EQ(cycles_until_inactive([&] { return two(kOut, kOut); }), 10);
  EXPECT_EQ(sut_.discrepancies(), 0u);
}

TEST_F(EstopInputTest, ABrokenContactStopsUntilBothWerePressedAndReleased) {
  two(kOut, kOut);
  for (int i = 0; i < 60; ++i) EXPECT_EQ(two(kIn, kOut), kIn);
  EXPECT_EQ(sut_.discrepancies(), 1u) << "once for each time";
  EXPECT_EQ(cycles_until_inactive([&] { return two(kOut, kOut); }), -1);
  EXPECT_EQ(two(kOut, kOut), kNot);
  for (int i = 0; i < 30; ++i) two(kIn, kOut);  // pressed, the contact is still broken
  EXPECT_EQ(cycles_until_inactive([&] { return two(kOut, kOut); }), -1);
  for (int i = 0; i < 30; ++i) EXPECT_EQ(two(kIn, kIn), kIn);
  EXPECT_EQ(cycles_until_inactive([&] { return two(kOut, kOut); }), 10);
}

TEST_F(EstopInputTest, AContactThatStaysInAfterTheReleaseIsADiscrepancyToo) {
  two(kOut, kOut);
  two(kIn, kIn);
  for (int i = 0; i < 40; ++i) EXPECT_EQ(two(kOut, kIn), kIn);
  EXPECT_EQ(sut_.discrepancies(), 1u);
  EXPECT_EQ(cycles_until_inactive([&] { return two(kOut, kOut); }), -1);
}

}  // namespace
}  // namespace gannet::safety
