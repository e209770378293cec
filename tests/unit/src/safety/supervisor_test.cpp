#include "src/safety/supervisor.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "platform/base/random.hpp"

namespace gannet::safety {
namespace {

constexpr State kAll[] = {State::kStarting, State::kStandby, State::kArmed,  State::kServoing,
                          State::kHolding,  State::kStopped, State::kFaulted};
constexpr TimePoint kNow = time_from_ns(1'000'000'000'000);

// All is well, a vehicle is there, no target is seen, nobody asks for anything.
Inputs quiet() {
  Inputs in;
  in.started = true;
  in.estop = Line::kInactive;
  in.has_vehicle = true;
  in.has_estop = true;
  in.drive_fault = false;
  in.drives_alive = true;
  in.drives_ready = true;
  in.drives_guarded = true;
  in.bus_ok = true;
  in.camera_alive = true;
  return in;
}

void see(Inputs& in) {
  in.track = TrackState::kLocked;
  in.estimate_valid = true;
  in.estimate_age = from_seconds(0.05);
  in.estimate_sigma_m = 0.002;
}

void hand(Inputs& in, double age_s) {
  in.manual_active = true;
  in.manual_age = from_seconds(age_s);
}

Memory in_state(State state, double for_s = 1) {
  return {state, Cause::kNone, kNow - from_seconds(for_s)};
}

State state_of(char letter) { return kAll[std::string("ABCDESF").find(letter)]; }

struct Row {
  const char* event;
  void (*apply)(Inputs&);
  // The next state from Starting, Standby, Armed, Servoing, Holding, Stopped, Faulted, as the
  // letters A B C D E S F.
  const char* next;
  Cause entered = Cause::kNone;  // cause of a state that the event itself leads to
};

const Row kRows[] = {
    {"nothing, no target", [](Inputs&) {}, "BBCEESF", Cause::kTargetNone},
    {"not started", [](Inputs& in) { in.started = false; }, "ABCEESF", Cause::kTargetNone},
    {"target locked", see, "BBDDDSF"},
    {"target coasting",
     [](Inputs& in) {
       see(in);
       in.track = TrackState::kCoasting;
     },
     "BBCDESF"},
    {"target searched",
     [](Inputs& in) {
       see(in);
       in.track = TrackState::kSearching;
     },
     "BBCEESF", Cause::kTargetNone},
    {"target lost",
     [](Inputs& in) {
       see(in);
       in.track = TrackState::kLost;
     },
     "BBCEESF", Cause::kTargetNone},
    {"no prediction",
     [](Inputs& in) {
       see(in);
       in.estimate_valid = false;
     },
     "BBCEESF", Cause::kTargetNone},
    {"target just young enough",
     [](Inputs& in) {
       see(in);
       in.estimate_age = from_seconds(0.3);
     },
     "BBDDDSF"},
    {"target too old",
     [](Inputs& in) {
       see(in);
       in.estimate_age = from_seconds(0.301);
     },
     "BBCEESF", Cause::kTargetOld},
    {"target from the future",
     [](Inputs& in) {
       see(in);
       in.estimate_age = from_seconds(-0.001);
     },
     "BBCEESF", Cause::kTargetOld},
    {"target uncertain",
     [](Inputs& in) {
       see(in);
       in.estimate_sigma_m = 0.051;
     },
     "BBCEESF", Cause::kTargetUncertain},
    {"target not a number",
     [](Inputs& in) {
       see(in);
       in.estimate_sigma_m = std::numeric_limits<double>::quiet_NaN();
     },
     "BBCEESF", Cause::kTargetUncertain},
    {"hand", [](Inputs& in) { hand(in, 0.1); }, "BBDDDSF"},
    {"hand too old", [](Inputs& in) { hand(in, 0.31); }, "BBCEESF", Cause::kTargetNone},
    {"hand from the future", [](Inputs& in) { hand(in, -0.1); }, "BBCEESF", Cause::kTargetNone},
    {"e-stop", [](Inputs& in) { in.estop = Line::kActive; }, "SSSSSSS", Cause::kEstop},
    {"e-stop unreadable", [](Inputs& in) { in.estop = Line::kUnknown; }, "SSSSSSS",
     Cause::kEstopUnknown},
    {"stop", [](Inputs& in) { in.request = Request::kStop; }, "SSSSSSS", Cause::kOperatorStop},
    {"internal fault", [](Inputs& in) { in.internal_fault = true; }, "FFFFFSF",
     Cause::kInternalFault},
    {"drive fault", [](Inputs& in) { in.drive_fault = true; }, "BBFFFSF", Cause::kDriveFault},
    {"drives silent", [](Inputs& in) { in.drives_alive = false; }, "BBFFFSF", Cause::kDrivesSilent},
    // Only arming asks for these: a drive that is lost while it runs says so as a fault.
    {"drives not ready", [](Inputs& in) { in.drives_ready = false; }, "BBCEESF",
     Cause::kTargetNone},
    {"drives unguarded", [](Inputs& in) { in.drives_guarded = false; }, "BBCEESF",
     Cause::kTargetNone},
    {"bus down", [](Inputs& in) { in.bus_ok = false; }, "BBFFFSF", Cause::kBusDown},
    {"overruns", [](Inputs& in) { in.overruns = true; }, "BBFFFSF", Cause::kOverruns},
    {"limits exceeded", [](Inputs& in) { in.limits_exceeded = true; }, "BBFFFSF", Cause::kLimits},
    {"cameras silent", [](Inputs& in) { in.camera_alive = false; }, "BBCEESF", Cause::kTargetNone},
    {"no vehicle", [](Inputs& in) { in.has_vehicle = false; }, "BBCEESF", Cause::kTargetNone},
    {"disarm", [](Inputs& in) { in.request = Request::kDisarm; }, "BBBBBSF", Cause::kDisarmed},
    {"reset", [](Inputs& in) { in.request = Request::kReset; }, "BBCEEBB"},
    {"arm", [](Inputs& in) { in.request = Request::kArm; }, "BCCEESF"},
    {"arm with a target",
     [](Inputs& in) {
       see(in);
       in.request = Request::kArm;
     },
     "BCDDDSF"},
    // One thing wrong is enough to refuse.
    {"arm, e-stop",
     [](Inputs& in) {
       in.request = Request::kArm;
       in.estop = Line::kActive;
     },
     "SSSSSSS", Cause::kEstop},
    {"arm, e-stop unreadable",
     [](Inputs& in) {
       in.request = Request::kArm;
       in.estop = Line::kUnknown;
     },
     "SSSSSSS", Cause::kEstopUnknown},
    {"arm, drive fault",
     [](Inputs& in) {
       in.request = Request::kArm;
       in.drive_fault = true;
     },
     "BBFFFSF", Cause::kDriveFault},
    {"arm, drives silent",
     [](Inputs& in) {
       in.request = Request::kArm;
       in.drives_alive = false;
     },
     "BBFFFSF", Cause::kDrivesSilent},
    {"arm, drives not ready",
     [](Inputs& in) {
       in.request = Request::kArm;
       in.drives_ready = false;
     },
     "BBCEESF", Cause::kTargetNone},
    {"arm, drives unguarded",
     [](Inputs& in) {
       in.request = Request::kArm;
       in.drives_guarded = false;
     },
     "BBCEESF", Cause::kTargetNone},
    {"arm, no e-stop line",
     [](Inputs& in) {
       in.request = Request::kArm;
       in.has_estop = false;
     },
     "BBCEESF", Cause::kTargetNone},
    {"arm, bus down",
     [](Inputs& in) {
       in.request = Request::kArm;
       in.bus_ok = false;
     },
     "BBFFFSF", Cause::kBusDown},
    {"arm, overruns",
     [](Inputs& in) {
       in.request = Request::kArm;
       in.overruns = true;
     },
     "BBFFFSF", Cause::kOverruns},
    {"arm, limits",
     [](Inputs& in) {
       in.request = Request::kArm;
       in.limits_exceeded = true;
     },
     "BBFFFSF", Cause::kLimits},
    {"arm, internal fault",
     [](Inputs& in) {
       in.request = Request::kArm;
       in.internal_fault = true;
     },
     "FFFFFSF", Cause::kInternalFault},
    {"arm, not started",
     [](Inputs& in) {
       in.request = Request::kArm;
       in.started = false;
       hand(in, 0.1);
     },
     "ABDDDSF"},
    {"arm, no vehicle",
     [](Inputs& in) {
       in.request = Request::kArm;
       in.has_vehicle = false;
     },
     "BBCEESF", Cause::kTargetNone},
    {"arm, cameras silent",
     [](Inputs& in) {
       in.request = Request::kArm;
       in.camera_alive = false;
     },
     "BBCEESF", Cause::kTargetNone},
    {"arm, cameras silent, but a hand",
     [](Inputs& in) {
       in.request = Request::kArm;
       in.camera_alive = false;
       hand(in, 0.1);
     },
     "BCDDDSF"},
    // Who wins.
    {"reset under e-stop",
     [](Inputs& in) {
       in.request = Request::kReset;
       in.estop = Line::kActive;
     },
     "SSSSSSS", Cause::kEstop},
    {"reset with an internal fault",
     [](Inputs& in) {
       in.request = Request::kReset;
       in.internal_fault = true;
     },
     "FFFFFSF", Cause::kInternalFault},
    {"reset with drives silent",
     [](Inputs& in) {
       in.request = Request::kReset;
       in.drives_alive = false;
     },
     "BBFFFBB", Cause::kDrivesSilent},
    {"e-stop with everything wrong",
     [](Inputs& in) {
       in = Inputs();
       in.internal_fault = true;
       in.overruns = true;
     },
     "SSSSSSS", Cause::kEstopUnknown},
    {"stop with an internal fault",
     [](Inputs& in) {
       in.request = Request::kStop;
       in.internal_fault = true;
     },
     "SSSSSSS", Cause::kOperatorStop},
    {"drive fault with a target",
     [](Inputs& in) {
       see(in);
       in.drive_fault = true;
     },
     "BBFFFSF", Cause::kDriveFault},
    {"disarm with a target",
     [](Inputs& in) {
       see(in);
       in.request = Request::kDisarm;
     },
     "BBBBBSF", Cause::kDisarmed},
};

Permit permit_of(State state) {
  switch (state) {
    case State::kServoing:
      return Permit::kFull;
    case State::kArmed:
    case State::kHolding:
      return Permit::kHoldOnly;
    default:
      return Permit::kNone;
  }
}

// Arming, a reset and a sight have no cause; a hold that the event did not ask for wants a target.
Cause cause_of(const Row& row, State from, State entered) {
  if (entered == State::kStandby && (from == State::kStopped || from == State::kFaulted)) {
    return Cause::kNone;
  }
  if (entered == State::kArmed || entered == State::kServoing) return Cause::kNone;
  if (entered == State::kHolding && row.entered == Cause::kNone) return Cause::kTargetNone;
  return row.entered;
}

TEST(Supervisor, goes_where_the_table_says_for_every_state_and_event) {
  for (const Row& row : kRows) {
    for (int s = 0; s < kStates; ++s) {
      Inputs in = quiet();
      row.apply(in);
      const Decision sut = step(SafetyConfig(), in_state(kAll[s]), in, kNow);
      SCOPED_TRACE(std::string(to_string(kAll[s])) + ", " + row.event);
      EXPECT_STREQ(to_string(sut.memory.state), to_string(state_of(row.next[s])));
      EXPECT_EQ(sut.outputs.permit, permit_of(sut.memory.state));
      EXPECT_EQ(sut.outputs.drive_enable, sut.outputs.permit != Permit::kNone);
      const bool moved = sut.memory.state != kAll[s];
      EXPECT_EQ(sut.memory.since, moved ? kNow : kNow - from_seconds(1));
      if (moved && kAll[s] != State::kStarting) {
        EXPECT_STREQ(to_string(sut.memory.cause),
                     to_string(cause_of(row, kAll[s], sut.memory.state)));
      }
    }
  }
}

TEST(Supervisor, disarms_what_held_for_too_long_and_nothing_else) {
  const char* expected = "BBCEBSF";
  for (int s = 0; s < kStates; ++s) {
    const Decision sut = step(SafetyConfig(), in_state(kAll[s], 10.01), quiet(), kNow);
    EXPECT_EQ(sut.memory.state, state_of(expected[s])) << to_string(kAll[s]);
  }
  const Decision still = step(SafetyConfig(), in_state(State::kHolding, 10), quiet(), kNow);
  EXPECT_EQ(still.memory.state, State::kHolding);
  Inputs in = quiet();
  see(in);
  EXPECT_EQ(step(SafetyConfig(), in_state(State::kHolding, 10.01), in, kNow).memory.state,
            State::kServoing);
}

TEST(Supervisor, says_why_it_refuses) {
  struct Case {
    void (*apply)(Inputs&);
    State state;
    Cause refused;
  };
  const Case cases[] = {
      {[](Inputs& in) { in.estop = Line::kActive; }, State::kStandby, Cause::kEstop},
      {[](Inputs& in) { in.estop = Line::kUnknown; }, State::kStandby, Cause::kEstopUnknown},
      {[](Inputs& in) { in.internal_fault = true; }, State::kStandby, Cause::kInternalFault},
      {[](Inputs& in) { in.has_vehicle = false; }, State::kStandby, Cause::kNoVehicle},
      {[](Inputs& in) { in.has_estop = false; }, State::kStandby, Cause::kNoEstop},
      {[](Inputs& in) { in.drive_fault = true; }, State::kStandby, Cause::kDriveFault},
      {[](Inputs& in) { in.drives_alive = false; }, State::kStandby, Cause::kDrivesSilent},
      {[](Inputs& in) { in.drives_ready = false; }, State::kStandby, Cause::kDrivesNotReady},
      {[](Inputs& in) { in.drives_guarded = false; }, State::kStandby, Cause::kDrivesUnguarded},
      {[](Inputs& in) { in.bus_ok = false; }, State::kStandby, Cause::kBusDown},
      {[](Inputs& in) { in.overruns = true; }, State::kStandby, Cause::kOverruns},
      {[](Inputs& in) { in.limits_exceeded = true; }, State::kStandby, Cause::kLimits},
      {[](Inputs& in) { in.camera_alive = false; }, State::kStandby, Cause::kNoCamera},
      {[](Inputs&) {}, State::kStarting, Cause::kNotStarted},
      // Stopped while starting, reset: a loop may still never have run.
      {[](Inputs& in) { in.started = false; }, State::kStandby, Cause::kNotStarted},
      {[](Inputs& in) {
         in.started = false;
         hand(in, 0.1);
       },
       State::kStandby, Cause::kNotStarted},
      {[](Inputs&) {}, State::kStopped, Cause::kNotReset},
      {[](Inputs&) {}, State::kFaulted, Cause::kNotReset},
      {[](Inputs&) {}, State::kStandby, Cause::kNone},
      {[](Inputs&) {}, State::kServoing, Cause::kNone},  // armed already
  };
  for (const Case& c : cases) {
    Inputs in = quiet();
    in.request = Request::kArm;
    c.apply(in);
    const Decision sut = step(SafetyConfig(), in_state(c.state), in, kNow);
    EXPECT_STREQ(to_string(sut.outputs.refused), to_string(c.refused));
    if (c.refused != Cause::kNone) {
      EXPECT_NE(sut.memory.state, State::kArmed);
    }
  }
}

TEST(Supervisor, arms_without_an_estop_where_the_config_accepts_it) {
  Inputs in = quiet();
  in.has_estop = false;
  in.request = Request::kArm;
  SafetyConfig config;
  EXPECT_EQ(step(config, in_state(State::kStandby), in, kNow).memory.state, State::kStandby);
  config.accept_no_estop = true;
  EXPECT_EQ(step(config, in_state(State::kStandby), in, kNow).memory.state, State::kArmed);
}

TEST(Supervisor, locks_the_release_unless_the_law_follows_a_target) {
  for (const State state : kAll) {
    Inputs in = quiet();
    EXPECT_TRUE(step(SafetyConfig(), in_state(state), in, kNow).outputs.release_locked);
    see(in);
    const Decision seen = step(SafetyConfig(), in_state(state), in, kNow);
    EXPECT_EQ(seen.outputs.release_locked, seen.memory.state != State::kServoing);
    hand(in, 0.1);
    const Decision by_hand = step(SafetyConfig(), in_state(state), in, kNow);
    EXPECT_TRUE(by_hand.outputs.release_locked);
    EXPECT_EQ(by_hand.outputs.by_hand, by_hand.memory.state == State::kServoing);
  }
}

TEST(Supervisor, keeps_the_cause_of_a_fault_until_a_person_resets_it) {
  Inputs in = quiet();
  in.bus_ok = false;
  Memory memory = step(SafetyConfig(), in_state(State::kServoing), in, kNow).memory;
  in = quiet();
  for (int i = 0; i < 100; ++i) {
    in.request = i % 2 == 0 ? Request::kArm : Request::kDisarm;
    const Decision sut = step(SafetyConfig(), memory, in, kNow);
    memory = sut.memory;
    EXPECT_EQ(sut.outputs.cause, Cause::kBusDown);
    EXPECT_EQ(sut.outputs.permit, Permit::kNone);
  }
  in.request = Request::kReset;
  memory = step(SafetyConfig(), memory, in, kNow).memory;
  EXPECT_EQ(memory.state, State::kStandby);
}

Inputs anything(Random& random) {
  const auto often = [&](int n) { return random.below(n) != 0; };
  Inputs in;
  in.started = often(4);
  in.estop = often(40) ? Line::kInactive : random.below(2) ? Line::kActive : Line::kUnknown;
  in.request = static_cast<Request>(random.below(12) < 8 ? 0 : random.below(5));
  in.has_vehicle = often(50);
  in.has_estop = often(50);
  in.internal_fault = !often(100);
  in.drive_fault = !often(60);
  in.drives_alive = often(60);
  in.drives_ready = often(20);
  in.drives_guarded = often(20);
  in.bus_ok = often(60);
  in.overruns = !often(60);
  in.limits_exceeded = !often(60);
  in.camera_alive = often(10);
  if (random.below(4) == 0) hand(in, random.uniform() - 0.2);
  in.track = static_cast<TrackState>(random.below(4));
  in.estimate_age = from_seconds(random.uniform() - 0.1);
  in.estimate_sigma_m = 0.1 * random.uniform();
  in.estimate_valid = often(5);
  return in;
}

bool is_armed(State s) {
  return s == State::kArmed || s == State::kServoing || s == State::kHolding;
}

TEST(Supervisor, holds_its_invariants_under_random_inputs) {
  Random random(20260101);
  Memory memory;
  TimePoint now = kNow;
  int visits[kStates] = {};
  for (int i = 0; i < 300000; ++i) {
    if (random.below(500) == 0) memory = Memory();  // a restart
    const Inputs in = anything(random);
    now += from_seconds(random.below(50) == 0 ? 12 : 0.005);
    const Decision sut = step(SafetyConfig(), memory, in, now);
    const State before = memory.state, after = sut.memory.state;
    ++visits[static_cast<int>(after)];
    ASSERT_EQ(sut.outputs.permit, permit_of(after));
    if (in.estop != Line::kInactive || in.request == Request::kStop) {
      ASSERT_EQ(after, State::kStopped);
    }
    if (is_armed(after) && !is_armed(before)) {
      ASSERT_EQ(before, State::kStandby);
      ASSERT_EQ(after, State::kArmed);
      ASSERT_EQ(in.request, Request::kArm);
      ASSERT_TRUE(in.has_vehicle && in.drives_alive && in.bus_ok && !in.drive_fault);
      ASSERT_TRUE(in.drives_ready && in.drives_guarded && in.has_estop);
    }
    if (before == State::kStopped && after != before) {
      ASSERT_EQ(in.request, Request::kReset);
    }
    if (before == State::kFaulted && after == State::kStandby) {
      ASSERT_EQ(in.request, Request::kReset);
    }
    if (is_armed(after)) {
      ASSERT_FALSE(in.drive_fault || !in.drives_alive || !in.bus_ok);
    }
    if (sut.outputs.permit == Permit::kFull && !sut.outputs.by_hand) {
      ASSERT_TRUE(in.estimate_valid && in.estimate_age <= from_seconds(0.3));
    }
    memory = sut.memory;
  }
  for (const int n : visits) EXPECT_GT(n, 100);
}

TEST(Supervisor, stops_for_the_line_whatever_vision_and_config_say) {
  Random random(7);
  for (int i = 0; i < 20000; ++i) {
    SafetyConfig config;
    config.full_age_s = 10 * random.uniform();
    config.hold_limit_s = random.uniform();
    Inputs in = anything(random);
    in.estop = random.below(2) ? Line::kActive : Line::kUnknown;
    const Decision sut = step(config, in_state(kAll[random.below(kStates)]), in, kNow);
    ASSERT_EQ(sut.memory.state, State::kStopped);
    ASSERT_EQ(sut.outputs.permit, Permit::kNone);
    ASSERT_FALSE(sut.outputs.drive_enable);
  }
}

TEST(Supervisor, names_every_state_and_cause_once) {
  for (int i = 0; i < kCauses; ++i) {
    for (int j = 0; j < i; ++j) {
      EXPECT_STRNE(to_string(static_cast<Cause>(i)), to_string(static_cast<Cause>(j)));
    }
  }
  EXPECT_STREQ(to_string(Cause::kDisarmed), "disarmed");
  EXPECT_STREQ(to_string(State::kFaulted), "faulted");
  EXPECT_STREQ(to_string(Permit::kHoldOnly), "hold_only");
  EXPECT_STREQ(to_string(Light::kFast), "fast");
}

}  // namespace
}  // namespace gannet::safety
