// The drive group against the simulated drives, over a bus that can delay and lose frames.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <numbers>
#include <string>

#include "hal/can/can_text.hpp"
#include "hal/drive/cia402_drive.hpp"
#include "platform/base/random.hpp"
#include "src/world/cia402_node.hpp"

namespace gannet::world {
namespace {

using hal::Cia402Drive;
using hal::DriveConfig;
using hal::DriveSetpoint;
using hal::DriveState;
using hal::cia402::AxisPhase;
using Power = Cia402Node::Power;
using std::chrono::milliseconds;

constexpr Duration kCycle = milliseconds(5);
constexpr double kRpmPerRadS = 60 / (2 * std::numbers::pi);

DriveConfig config_of(int motors) {
  DriveConfig config;
  config.kind = "cia402";
  config.feedback_timeout_s = 0.1;
  for (int i = 0; i < motors; ++i) {
    config.motors.push_back({.node_id = 0x15 + i, .full_speed_rad_s = 300});
  }
  return config;
}

class Loop {
 public:
  explicit Loop(const DriveConfig& config, bool powered = true)
      : config_(config), drive_(std::move(Cia402Drive::create(config)).value()) {
    for (const auto& motor : config.motors) nodes_.emplace_back(motor.node_id);
    setpoints_.resize(config.motors.size());
    if (powered) {
      for (Cia402Node& node : nodes_) node.power_on(now_);
    }
  }

  void cycle() {
    now_ += kCycle;
    while (!to_drive_.empty() && to_drive_.front().first <= now_) {
      drive_->receive(to_drive_.front().second, now_);
      to_drive_.pop_front();
    }
    health_ = drive_->health(now_);
    if (is_master_alive) {
      hal::CanFrame out[64];
      const int n = drive_->send(setpoints_, enable, now_, out);
      EXPECT_LE(n, drive_->max_frames());
      for (int i = 0; i < n; ++i) {
        log_ += hal::to_text(out[i]) + "\n";
        note(out[i]);
        if (random_.uniform() < loss) continue;
        for (std::size_t k = 0; k < nodes_.size(); ++k) {
          if (!is_silent(k)) nodes_[k].hear(out[i], now_);
        }
      }
    }
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
      Cia402Node& node = nodes_[k];
      node.measure(node.demand(), 2500, 24000, increments);
      node.step(now_);
      for (const hal::CanFrame& frame : node.take_said()) {
        log_ += "  " + hal::to_text(frame) + "\n";
        note(frame);
        if (random_.uniform() < loss || is_silent(k)) continue;
        to_drive_.emplace_back(now_ + late, frame);
      }
    }
  }
  void run(double seconds) {
    for (int i = 0; i < static_cast<int>(std::lround(seconds / to_seconds(kCycle))); ++i) cycle();
  }
  // Cycles until it is so; -1: not within 5 s.
  int until(const std::function<bool()>& is_so) {
    for (int i = 0; i < 1000; ++i) {
      if (is_so()) return i;
      cycle();
    }
    return -1;
  }
  void arm(double value = 0) {
    for (DriveSetpoint& s : setpoints_) s.value = value;
    ASSERT_GE(until([&] { return health_.all_ready && health_.all_alive; }), 0);
    enable = true;
    ASSERT_GE(until([&] {
                for (const auto& f : drive_->feedback()) {
                  if (f.state != DriveState::kEnabled) return false;
                }
                return true;
              }),
              0);
  }

  Cia402Drive& drive() { return *drive_; }
  Cia402Node& node(std::size_t i = 0) { return nodes_[i]; }
  const hal::cia402::Cia402Axis& axis(std::size_t i = 0) { return drive_->axes()[i]; }
  const hal::DriveGroupHealth& health() const { return health_; }
  const std::string& log() const { return log_; }
  const std::string& candump() const { return candump_; }
  TimePoint now() const { return now_; }
  void set(double value, std::size_t i = 0) { setpoints_[i].value = value; }
  void silence(std::size_t i, bool silent) {
    silent_.resize(nodes_.size());
    silent_[i] = silent;
  }
  // A new daemon on the same bus.
  void restart_master() { drive_ = std::move(Cia402Drive::create(config_)).value(); }

  bool enable = false, is_master_alive = true;
  double loss = 0;
  double increments = 0;  // 6064 of every drive
  Duration late = {};

 private:
  void note(const hal::CanFrame& frame) {
    candump_ += hal::to_text(hal::CanLogLine{to_ns(now_) / 1000, "can0", frame}) + "\n";
  }
  bool is_silent(std::size_t i) const { return i < silent_.size() && silent_[i]; }

  DriveConfig config_;
  std::unique_ptr<Cia402Drive> drive_;
  std::vector<Cia402Node> nodes_;
  std::vector<DriveSetpoint> setpoints_;
  std::vector<bool> silent_;
  std::deque<std::pair<TimePoint, hal::CanFrame>> to_drive_;
  hal::DriveGroupHealth health_ = {.all_ready = false};
  Random random_{11};
  TimePoint now_ = time_from_ns(1'000'000'000);
  std::string log_, candump_;
};

TEST(Cia402Loop, SetsEveryDriveUpAndFindsThatItGuardsItself) {
  Loop sut(config_of(8));
  EXPECT_GE(sut.until([&] { return sut.health().all_ready; }), 0);
  EXPECT_TRUE(sut.health().all_alive);
  EXPECT_TRUE(sut.health().guards_itself);
  EXPECT_FALSE(sut.health().any_fault);
  EXPECT_EQ(sut.health().first_bad, -1);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(sut.node(i).nmt(), 5);
    EXPECT_EQ(sut.node(i).power(), Power::kSwitchOnDisabled);  // nothing is on before it is armed
    EXPECT_EQ(sut.drive().feedback()[i].state, DriveState::kDisabled);
  }
  EXPECT_EQ(sut.drive().malformed(), 0u);
}

TEST(Cia402Loop, RunsInBothModesAtTheFractionOfFullSpeed) {
  for (const char* mode : {"profile_velocity", "cyclic_velocity"}) {
    DriveConfig config = config_of(2);
    config.cia402.mode = mode;
    Loop sut(config);
    sut.arm(0.5);
    sut.set(-0.25, 1);
    sut.run(0.3);
    EXPECT_EQ(sut.node(0).power(), Power::kOperationEnabled) << mode;
    EXPECT_NEAR(sut.node(0).demand(), 150 * kRpmPerRadS, 1) << mode;
    EXPECT_NEAR(sut.node(1).demand(), -75 * kRpmPerRadS, 1) << mode;
    EXPECT_NEAR(sut.drive().feedback()[0].speed_rad_s, 150, 0.1) << mode;
    EXPECT_NEAR(sut.drive().feedback()[1].speed_rad_s, -75, 0.1) << mode;
    EXPECT_NEAR(sut.drive().feedback()[0].current_a, 2.5, 1e-9) << mode;
    EXPECT_TRUE(std::isnan(sut.drive().feedback()[0].voltage_v));
  }
}

TEST(Cia402Loop, EnablesWithinAFewCycles) {
  Loop sut(config_of(1));
  ASSERT_GE(sut.until([&] { return sut.health().all_ready; }), 0);
  sut.run(0.1);
  sut.enable = true;
  const int cycles = sut.until([&] { return sut.node().power() == Power::kOperationEnabled; });
  EXPECT_GE(cycles, 3);  // shutdown, switch on, enable operation
  EXPECT_LE(cycles, 8);
}

TEST(Cia402Loop, CountsInTheDrivesUnitsBehindTheGearBothWays) {
  DriveConfig config = config_of(1);
  config.cia402.velocity_unit = "increments_per_s";
  config.cia402.increments_per_rev = 2000;
  config.cia402.gear_ratio = 5;
  config.motors[0].full_speed_rad_s = 2 * std::numbers::pi;  // one turn of the shaft a second
  config.motors[0].reversed = true;
  config.motors[0].max_command = 0.5;
  Loop sut(config);
  sut.arm(1);
  sut.run(0.5);
  EXPECT_EQ(sut.node().demand(), -5000);  // half of 2000 × 5, the other way
  EXPECT_NEAR(sut.drive().feedback()[0].speed_rad_s, std::numbers::pi, 1e-9);
}

TEST(Cia402Loop, StopsByTheQuickStopRampThenSwitchesOff) {
  DriveConfig config = config_of(1);
  config.cia402.quick_stop_rad_s2 = 1000;
  Loop sut(config);
  sut.arm(1);
  sut.run(0.5);
  sut.enable = false;
  sut.run(0.02);
  EXPECT_EQ(sut.node().power(), Power::kQuickStopActive);
  EXPECT_GT(sut.node().demand(), 100);
  sut.run(0.4);
  EXPECT_EQ(sut.node().power(), Power::kSwitchOnDisabled);
  EXPECT_EQ(sut.node().demand(), 0);
  EXPECT_FALSE(sut.health().any_fault);
}

TEST(Cia402Loop, CoastsWhereTheConfigSaysSo) {
  DriveConfig config = config_of(1);
  config.cia402.stop = "disable_voltage";
  Loop sut(config);
  sut.arm(1);
  sut.run(0.5);
  sut.enable = false;
  sut.run(0.01);
  EXPECT_EQ(sut.node().power(), Power::kSwitchOnDisabled);
}

TEST(Cia402Loop, TakesTheVoltageFromADriveThatDoesNotEndItsQuickStop) {
  DriveConfig config = config_of(1);
  config.cia402.quick_stop_rad_s2 = 1;  // would take five minutes
  config.cia402.stop_time_s = 0.3;
  Loop sut(config);
  sut.arm(1);
  sut.run(0.5);
  sut.enable = false;
  sut.run(0.25);
  EXPECT_EQ(sut.node().power(), Power::kQuickStopActive);
  sut.run(0.1);
  EXPECT_EQ(sut.node().power(), Power::kSwitchOnDisabled);
}

TEST(Cia402Loop, HaltsAMotorWithoutASetpointAndRunsOnWithOne) {
  Loop sut(config_of(1));
  sut.arm(0.5);
  sut.run(0.3);
  sut.set(std::numeric_limits<double>::quiet_NaN());
  sut.run(0.3);
  EXPECT_EQ(sut.node().power(), Power::kOperationEnabled);
  EXPECT_EQ(sut.node().demand(), 0);
  EXPECT_GT(sut.drive().counters().bad_setpoints, 0u);
  sut.set(0.5);
  sut.run(0.3);
  EXPECT_NEAR(sut.node().demand(), 150 * kRpmPerRadS, 1);
}

TEST(Cia402Loop, ADriveThatRestartsWhileArmedIsAFaultAndStaysOffUntilEnabledAnew) {
  Loop sut(config_of(2));
  sut.arm(0.5);
  sut.run(0.2);
  sut.node(1).power_on(sut.now());
  sut.run(0.01);
  EXPECT_TRUE(sut.health().any_fault);
  EXPECT_EQ(sut.health().first_bad, 1);
  EXPECT_STREQ(sut.health().trouble, "drive restarted");
  // It is set up again, and nothing moves although enable is still there.
  sut.run(3);
  EXPECT_EQ(sut.node(1).nmt(), 5);
  EXPECT_EQ(sut.node(1).power(), Power::kSwitchOnDisabled);
  EXPECT_EQ(sut.node(1).demand(), 0);
  EXPECT_TRUE(sut.health().any_fault);
  sut.enable = false;
  sut.run(0.1);
  EXPECT_FALSE(sut.health().any_fault);
  EXPECT_TRUE(sut.health().all_ready);
  sut.enable = true;
  sut.run(0.3);
  EXPECT_NEAR(sut.node(1).demand(), 150 * kRpmPerRadS, 1);
}

TEST(Cia402Loop, ARestartWhileNotArmedIsNoFault) {
  Loop sut(config_of(1));
  ASSERT_GE(sut.until([&] { return sut.health().all_ready; }), 0);
  sut.node().power_on(sut.now());
  sut.run(0.02);
  EXPECT_FALSE(sut.health().all_ready);
  EXPECT_FALSE(sut.health().any_fault);
  EXPECT_GE(sut.until([&] { return sut.health().all_ready; }), 0);
}

TEST(Cia402Loop, ASilentDriveIsNoticedByItsFeedbackThenByItsHeartbeat) {
  Loop sut(config_of(2));
  sut.arm(0.5);
  sut.silence(0, true);
  sut.run(0.09);
  EXPECT_TRUE(sut.health().all_alive);
  sut.run(0.03);
  EXPECT_FALSE(sut.health().all_alive);
  EXPECT_EQ(sut.health().first_bad, 0);
  sut.run(0.4);
  EXPECT_TRUE(sut.health().any_fault);
  EXPECT_EQ(sut.drive().feedback()[0].fault_code, 0x8130);
  // The drive has not heard us either, and has stopped by itself.
  EXPECT_NE(sut.node(0).power(), Power::kOperationEnabled);
  EXPECT_EQ(sut.node(0).demand(), 0);
  EXPECT_EQ(sut.node(1).power(), Power::kOperationEnabled);  // the supervisor's business
  sut.silence(0, false);
  sut.run(3);
  EXPECT_EQ(sut.node(0).demand(), 0);
  EXPECT_TRUE(sut.health().any_fault);
}

TEST(Cia402Loop, StopsByItselfWithinTheGuardTimeWhenTheMasterDies) {
  for (const auto& [reaction, power] : {std::pair("quick_stop", Power::kSwitchOnDisabled),
                                        std::pair("disable_voltage", Power::kSwitchOnDisabled),
                                        std::pair("fault", Power::kFault)}) {
    DriveConfig config = config_of(3);
    config.cia402.guard_reaction = reaction;
    config.cia402.quick_stop_rad_s2 = 3000;
    Loop sut(config);
    sut.arm(1);
    sut.run(0.5);
    sut.is_master_alive = false;
    sut.run(0.14);  // the last heartbeat was at most 50 ms ago
    EXPECT_EQ(sut.node().power(), Power::kOperationEnabled) << reaction;
    sut.run(0.07);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NE(sut.node(i).power(), Power::kOperationEnabled) << reaction;
      EXPECT_EQ(sut.node(i).nmt(), 127) << reaction;
    }
    sut.run(0.2);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(sut.node(i).power(), power) << reaction;
      EXPECT_EQ(sut.node(i).demand(), 0) << reaction;
      EXPECT_EQ(sut.node(i).guard_events(), 1u);
    }
  }
}

TEST(Cia402Loop, ANewMasterFindsDrivesThatStoppedByThemselves) {
  DriveConfig config = config_of(2);
  config.cia402.guard_reaction = "fault";
  Loop sut(config);
  sut.arm(1);
  sut.is_master_alive = false;
  sut.run(1);
  sut.restart_master();
  sut.is_master_alive = true;
  sut.enable = false;
  ASSERT_GE(sut.until([&] { return sut.health().all_ready; }), 0);
  sut.run(0.1);
  EXPECT_TRUE(sut.health().any_fault);  // a person's reset is wanted
  EXPECT_STREQ(sut.health().trouble, "heartbeat lost");
  sut.drive().reset_faults(sut.now());
  sut.run(2);
  EXPECT_FALSE(sut.health().any_fault);
  EXPECT_NE(sut.log().find("000#8215"), std::string::npos);  // communication was reset first
  sut.arm(0.5);
  sut.run(0.3);
  EXPECT_NEAR(sut.node().demand(), 150 * kRpmPerRadS, 1);
}

TEST(Cia402Loop, ANewMasterStopsADriveThatRunsOnUnguarded) {
  DriveConfig config = config_of(1);
  config.cia402.accept_unguarded = true;
  Loop sut(config);
  sut.node().lack(0x1016);
  sut.node().lack(0x1400, 5);
  sut.arm(1);
  sut.is_master_alive = false;
  sut.run(2);
  EXPECT_EQ(sut.node().power(), Power::kOperationEnabled);
  sut.restart_master();
  sut.is_master_alive = true;
  sut.enable = false;
  sut.run(0.3);
  EXPECT_EQ(sut.node().power(), Power::kSwitchOnDisabled);
  EXPECT_EQ(sut.node().demand(), 0);
}

TEST(Cia402Loop, AFaultStopsTheMotorAndIsLeftByResetAloneOnceItsCauseIsGone) {
  Loop sut(config_of(2));
  sut.arm(0.5);
  sut.run(0.2);
  sut.node(0).set_fault(0x4310);
  sut.run(0.3);
  EXPECT_EQ(sut.node(0).power(), Power::kFault);
  EXPECT_TRUE(sut.health().any_fault);
  EXPECT_EQ(sut.health().first_bad, 0);
  EXPECT_EQ(sut.health().trouble_code, 0x4310u);
  EXPECT_STREQ(sut.health().trouble, "power stage temperature too high");
  EXPECT_EQ(sut.drive().feedback()[0].state, DriveState::kFault);
  EXPECT_EQ(sut.drive().feedback()[0].error_count, 1u);
  sut.enable = false;
  sut.run(0.1);
  sut.drive().reset_faults(sut.now());
  sut.run(1);
  EXPECT_EQ(sut.node(0).power(), Power::kFault);  // it is still hot
  sut.node(0).set_fault(0);
  sut.run(6);
  EXPECT_EQ(sut.node(0).power(), Power::kFault);  // nobody resets by itself
  sut.drive().reset_faults(sut.now());
  sut.run(0.1);
  EXPECT_EQ(sut.node(0).power(), Power::kSwitchOnDisabled);
  EXPECT_FALSE(sut.health().any_fault);
  EXPECT_EQ(sut.drive().feedback()[0].fault_code, 0);
}

TEST(Cia402Loop, AResetWhileEnabledDoesNothing) {
  Loop sut(config_of(1));
  sut.arm(0.5);
  sut.node().set_fault(0x7121);
  sut.run(0.2);
  sut.node().set_fault(0);
  sut.drive().reset_faults(sut.now());
  sut.run(1);
  EXPECT_EQ(sut.node().power(), Power::kFault);
}

TEST(Cia402Loop, AFaultWhoseEmcyWasLostIsAskedFor) {
  Loop sut(config_of(1));
  ASSERT_GE(sut.until([&] { return sut.health().all_ready; }), 0);
  sut.run(0.1);
  sut.node().set_fault(0x3210);
  sut.loss = 1;
  sut.run(0.01);
  sut.loss = 0;
  sut.run(0.1);
  EXPECT_EQ(sut.drive().feedback()[0].error_count, 0u);
  EXPECT_EQ(sut.drive().feedback()[0].fault_code, 0x3210);
}

TEST(Cia402Loop, ADriveThatDisablesItselfIsAFaultNotEnabledAgain) {
  Loop sut(config_of(1));
  sut.arm(0.5);
  sut.run(0.1);
  sut.node().hear(*hal::can_frame_from_text("215#000000000000"), sut.now());  // somebody else
  sut.run(0.5);
  EXPECT_EQ(sut.node().power(), Power::kSwitchOnDisabled);
  EXPECT_TRUE(sut.health().any_fault);
  EXPECT_STREQ(sut.health().trouble, "the drive disabled itself");
}

TEST(Cia402Loop, ADriveTakenOutOfOperationalIsAFaultWhileArmed) {
  Loop sut(config_of(1));
  sut.arm(0.5);
  sut.node().hear(*hal::can_frame_from_text("000#8000"), sut.now());
  sut.run(0.15);
  EXPECT_TRUE(sut.health().any_fault);
  sut.run(2);
  EXPECT_NE(sut.node().power(), Power::kOperationEnabled);
}

TEST(Cia402Loop, SaysWhenADriveWouldNotStopByItself) {
  struct Case {
    std::vector<std::pair<std::uint16_t, int>> lacks;
    bool guards;
  };
  const Case cases[] = {
      {{{0x6007, -1}}, true},  // the RPDO's timer stands in
      {{{0x1016, -1}}, true},
      {{{0x6007, -1}, {0x1400, 5}}, false},
      {{{0x1016, -1}, {0x1400, 5}}, false},
      {{{0x1029, -1}, {0x1400, 5}}, true},
  };
  for (const Case& c : cases) {
    for (const bool accepts : {false, true}) {
      DriveConfig config = config_of(2);
      config.cia402.accept_unguarded = accepts;
      Loop sut(config);
      for (const auto& [index, sub] : c.lacks) sut.node(1).lack(index, sub);
      ASSERT_GE(sut.until([&] { return sut.health().all_ready; }), 0);
      EXPECT_EQ(sut.axis(1).guards_itself(), c.guards);
      EXPECT_EQ(sut.health().guards_itself, c.guards || accepts);
      EXPECT_EQ(sut.health().first_bad, c.guards || accepts ? -1 : 1);
    }
  }
}

TEST(Cia402Loop, AReactionThatIsFixedAtNothingIsNoGuard) {
  Loop sut(config_of(1));
  sut.node().lack(0x1400, 5);
  sut.node().fix(0x6007);  // at its default: fault
  ASSERT_GE(sut.until([&] { return sut.health().all_ready; }), 0);
  EXPECT_TRUE(sut.health().guards_itself);
}

TEST(Cia402Loop, StopsByTheRpdoTimerWhereThereIsNoConsumerHeartbeat) {
  Loop sut(config_of(1));
  sut.node().lack(0x1016);
  sut.arm(1);
  sut.run(1);
  EXPECT_EQ(sut.node().power(), Power::kOperationEnabled);
  sut.is_master_alive = false;
  sut.run(0.3);
  EXPECT_EQ(sut.node().guard_events(), 1u);
}

TEST(Cia402Loop, RefusesADriveWhosePdoIsFixedOtherwiseAndSaysAtWhichObject) {
  Loop sut(config_of(2));
  sut.node(1).fix(0x1A00);
  sut.run(2);
  EXPECT_EQ(sut.axis(1).phase(), AxisPhase::kRefused);
  EXPECT_FALSE(sut.health().all_ready);
  EXPECT_TRUE(sut.health().all_alive);
  EXPECT_FALSE(sut.health().any_fault);
  EXPECT_EQ(sut.health().first_bad, 1);
  EXPECT_EQ(sut.health().trouble_code, 0x1A0000u);
  EXPECT_STREQ(sut.health().trouble, "an object has not the value that is wanted");
}

TEST(Cia402Loop, TakesADriveWhoseMappingIsFixedAsWanted) {
  DriveConfig config = config_of(1);
  Loop first(config);
  ASSERT_GE(first.until([&] { return first.health().all_ready; }), 0);
  for (const std::uint16_t index : {0x1600, 0x1A00}) first.node().fix(index);
  first.restart_master();  // the drive keeps what was set
  EXPECT_GE(first.until([&] { return !first.health().all_ready; }), 0);
  EXPECT_GE(first.until([&] { return first.health().all_ready; }), 0);
}

TEST(Cia402Loop, UsesThePdoThatTheConfigSays) {
  DriveConfig config = config_of(1);
  config.cia402.pdo = 3;
  config.cia402.report_current = false;
  Loop sut(config);
  sut.arm(0.5);
  sut.run(0.3);
  EXPECT_NEAR(sut.drive().feedback()[0].speed_rad_s, 150, 0.1);
  EXPECT_TRUE(std::isnan(sut.drive().feedback()[0].current_a));
  EXPECT_NE(sut.log().find("\n415#0F00"), std::string::npos);
  EXPECT_NE(sut.log().find("  395#3706"), std::string::npos);
}

TEST(Cia402Loop, BringsThePositionWhereTheConfigWantsIt) {
  for (const bool reversed : {false, true}) {
    DriveConfig config = config_of(2);
    config.cia402.report_position = true;
    config.cia402.increments_per_rev = 8192;
    config.cia402.gear_ratio = 50;
    config.motors[0].reversed = config.motors[1].reversed = reversed;
    Loop sut(config);
    EXPECT_TRUE(std::isnan(sut.drive().feedback()[0].position_rad));
    sut.increments = -3 * 8192 * 50;  // three turns of the shaft
    sut.arm(0.1);
    sut.run(0.1);
    const double turns = reversed ? 3 : -3;
    EXPECT_NEAR(sut.drive().feedback()[0].position_rad, turns * 2 * std::numbers::pi, 1e-9);
    EXPECT_NE(sut.drive().feedback()[0].speed_rad_s, 0);
    // A position that stays away is not kept for a new one; status and speed go on.
    sut.node(1).lack(0x1801);
    sut.run(0.05);
    EXPECT_TRUE(std::isnan(sut.drive().feedback()[1].position_rad));
    EXPECT_FALSE(std::isnan(sut.drive().feedback()[0].position_rad));
    EXPECT_TRUE(sut.health().all_alive);
  }
}

TEST(Cia402Loop, SetsUpADriveWithoutPositionOnlyWhereNoneIsWanted) {
  DriveConfig config = config_of(1);
  Loop without(config);
  without.node().lack(0x6064);
  EXPECT_GE(without.until([&] { return without.health().all_ready; }), 0);
  EXPECT_TRUE(std::isnan(without.drive().feedback()[0].position_rad));
  config.cia402.report_position = true;
  Loop with(config);
  with.node().lack(0x6064);
  with.run(2);
  EXPECT_FALSE(with.health().all_ready);
}

TEST(Cia402Loop, AModeThatTheDriveRefusesSaysItsAbortCode) {
  Loop sut(config_of(1));
  sut.node().fix(0x6060);
  sut.run(2);
  EXPECT_EQ(sut.axis().refusal().object, (hal::canopen::ObjectId{0x6060, 0}));
  EXPECT_STREQ(sut.health().trouble, "the object is read-only");
}

TEST(Cia402Loop, WaitsForADriveThatIsSwitchedOnLater) {
  Loop sut(config_of(1), false);
  sut.run(3);
  EXPECT_FALSE(sut.health().all_alive);
  EXPECT_FALSE(sut.health().all_ready);
  sut.node().power_on(sut.now());
  EXPECT_GE(sut.until([&] { return sut.health().all_ready; }), 0);
  sut.arm(0.1);
}

TEST(Cia402Loop, AFrameOftenLostOrLateDoesNotKeepItFromWorking) {
  for (const int late_ms : {0, 12, 40}) {
    Loop sut(config_of(4));
    sut.loss = 0.05;
    sut.late = milliseconds(late_ms);
    sut.run(10);
    sut.arm(0.5);
    sut.run(1);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(sut.node(i).power(), Power::kOperationEnabled) << late_ms;
      EXPECT_NEAR(sut.node(i).demand(), 150 * kRpmPerRadS, 1) << late_ms;
    }
    EXPECT_FALSE(sut.health().any_fault) << late_ms;
  }
}

TEST(Cia402Loop, SaysTheSameBitForBitTwice) {
  std::string logs[2];
  for (std::string& log : logs) {
    Loop sut(config_of(3));
    sut.loss = 0.1;
    sut.run(1.5);
    sut.enable = true;
    sut.run(0.5);
    log = sut.log();
  }
  EXPECT_EQ(logs[0], logs[1]);
  EXPECT_GT(logs[0].size(), 10000u);
}

// A whole session as `candump -L` would have it: set-up, enable, run, a fault and its reset, quick
// stop, the master's death. Kept in tests/golden, where foreign programs read it
// (tests/golden/cia402_tshark.sh). GANNET_WRITE_GOLDEN=1 writes it anew.
TEST(Cia402Loop, SaysWhatTheKeptSessionSays) {
  Loop sut(config_of(1));
  sut.run(0.6);
  sut.enable = true;
  sut.run(0.05);
  sut.set(0.5);
  sut.run(0.05);
  sut.node().set_fault(0x4310);
  sut.run(0.02);
  sut.enable = false;
  sut.node().set_fault(0);
  sut.run(0.02);
  sut.drive().reset_faults(sut.now());
  sut.run(0.03);
  sut.enable = true;
  sut.run(0.05);
  sut.enable = false;
  sut.run(0.03);
  sut.is_master_alive = false;
  sut.run(0.25);
  const char* path = "tests/golden/cia402_session.log";
  if (std::getenv("GANNET_WRITE_GOLDEN") != nullptr) std::ofstream(path) << sut.candump();
  std::ifstream file(path);
  const std::string kept((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_EQ(sut.candump(), kept);
}

}  // namespace
}  // namespace gannet::world
