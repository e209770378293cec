#include "hal/drive/vesc_drive.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "hal/drive/drive_kinds.hpp"
#include "platform/base/random.hpp"
#include "tests/unit/hal/drive/frames.hpp"

namespace gannet::hal {
namespace {

const char* const kStatus = "00000915#0000000000000000";

const char* const kWell = "0000080A#1501320000800000";  // no fault

constexpr TimePoint at_ms(std::int64_t ms) { return TimePoint(std::chrono::milliseconds(ms)); }

DriveConfig with_motors(int motors) {
  DriveConfig config;
  config.kind = "vesc";
  for (int i = 0; i < motors; ++i) {
    config.motors.push_back({.node_id = 0x15 + i, .reversed = i % 2 == 1, .pole_pairs = 7});
  }
  return config;
}

// Answers that our drive, id 10, understands: value of node for a mask.
std::string answer(int node, bool timeout, int value) {
  char text[40];
  std::snprintf(text, sizeof text, "0000080A#%02X0132%s%02X", static_cast<unsigned>(node),
                timeout ? "00200000" : "00008000", static_cast<unsigned>(value));
  return text;
}

class VescDriveTest : public testing::Test {
 protected:
  void make(const DriveConfig& config) { sut_ = std::move(*VescDrive::create(config)); }
  void hear(const Texts& texts) {
    for (const CanFrame& frame : frames_from(texts)) sut_->receive(frame, at_ms(ms_));
  }
  // Commands alone, without the questions.
  Texts send(const std::vector<double>& values, bool enable) {
    Texts commands;
    for (const std::string& text : send_all(values, enable)) {
      if (text.substr(0, 6) != "000008") commands.push_back(text);
    }
    return commands;
  }
  Texts send_all(const std::vector<double>& values, bool enable) {
    std::vector<DriveSetpoint> setpoints;
    for (double value : values) setpoints.push_back({value});
    std::vector<CanFrame> out(static_cast<std::size_t>(sut_->max_frames()));
    const int n = sut_->send(setpoints, enable, at_ms(ms_), out);
    ms_ += 5;
    return texts_of(std::span(out).first(static_cast<std::size_t>(n)));
  }
  void idle(int cycles, const Texts& heard) {
    for (int i = 0; i < cycles; ++i) {
      hear(heard);
      send({}, false);
    }
  }
  int stops_in(int cycles, const Texts& heard) {
    int stops = 0;
    for (int i = 0; i < cycles; ++i) {
      hear(heard);
      const Texts sent = send({1}, false);
      stops += static_cast<int>(std::count(sent.begin(), sent.end(), "00000115#00000000"));
    }
    return stops;
  }
  DriveGroupHealth health() const { return sut_->health(at_ms(ms_)); }

  std::unique_ptr<VescDrive> sut_;
  std::int64_t ms_ = 1000;
};

TEST_F(VescDriveTest, CommandsDutyByTheVehiclesSign) {
  make(with_motors(2));
  EXPECT_EQ(send({0.5, 0.5}, true), (Texts{"00000015#0000B98C", "00000016#FFFF4674"}));
  EXPECT_EQ(send({9, -9}, true), (Texts{"00000015#00017318", "00000016#00017318"}));
}

TEST_F(VescDriveTest, CommandsElectricalSpeed) {
  DriveConfig config = with_motors(2);
  config.vesc.mode = "speed";
  for (MotorConfig& motor : config.motors) motor.full_speed_rad_s = 100 * M_PI;  // 3000 rpm
  make(config);
  // 0.5 × 3000 rpm × 7 pole pairs = 10500.
  EXPECT_EQ(send({0.5, 0.5}, true), (Texts{"00000315#00002904", "00000316#FFFFD6FC"}));
}

TEST_F(VescDriveTest, CommandsCurrent) {
  DriveConfig config = with_motors(1);
  config.vesc.mode = "current";
  config.motors[0].max_command = 0.5;
  make(config);
  EXPECT_EQ(send({-1}, true), (Texts{"00000115#FFFFD8F0"}));  // 10 A of 20
}

TEST_F(VescDriveTest, StopsForAWhileThenKeepsSilent) {
  make(with_motors(1));
  hear({kStatus});
  send({1}, true);
  EXPECT_EQ(send({1}, false), (Texts{"00000115#00000000"}));
  EXPECT_EQ(stops_in(400, {kStatus}), 100);  // half a second
  hear({kStatus});
  EXPECT_EQ(send({0.1}, true).size(), 1u);
}

// What waited in a queue may reach it when the bus or its supply returns: a stop must follow.
TEST_F(VescDriveTest, OneThatIsAwayIsToldToStopUntilItHasBeenBackForAWhile) {
  make(with_motors(1));
  hear({kStatus});
  send({1}, true);
  EXPECT_EQ(stops_in(1000, {}), 1000);
  EXPECT_EQ(stops_in(400, {kStatus}), 100);
  EXPECT_TRUE(send({1}, false).empty());
}

TEST_F(VescDriveTest, OneThatIsAwayDoesNotKeepTheOthersFromShowingTheirTimeOut) {
  make(with_motors(2));
  idle(120, {kStatus, kWell});
  EXPECT_EQ(send({}, false), (Texts{"00000116#00000000"}));
  hear({answer(0x15, true, 1)});
  EXPECT_EQ(health().first_bad, 1);
}

// Else one that was cut off as it was disabled could be left alone before it is missed.
TEST_F(VescDriveTest, StopsAreSaidForNoShorterThanAnAbsenceGoesUnseen) {
  DriveConfig config = with_motors(1);
  config.vesc.stop_time_s = 0.1;
  make(config);
  hear({kStatus});
  send({1}, true);
  EXPECT_EQ(stops_in(400, {}), 400);
}

// A bus that refuses one must not delay it by a period.
TEST_F(VescDriveTest, ALongerCommandPeriodIsNotThatOfStops) {
  DriveConfig config = with_motors(1);
  config.command_period_s = 0.1;
  make(config);
  hear({kStatus});
  EXPECT_EQ(send({1}, true).size(), 1u);
  EXPECT_EQ(send({1}, true).size(), 0u);
  EXPECT_EQ(stops_in(40, {kStatus}), 40);
}

TEST_F(VescDriveTest, StopsByTheBrakeWhereTheConfigSaysSo) {
  DriveConfig config = with_motors(1);
  config.vesc.stop = "brake";
  make(config);
  EXPECT_EQ(send({1}, false), (Texts{"00000215#00001388"}));
}

TEST_F(VescDriveTest, SetpointsThatAreNoneStop) {
  make(with_motors(2));
  EXPECT_EQ(send({std::numeric_limits<double>::quiet_NaN()}, true),
            (Texts{"00000115#00000000", "00000116#00000000"}));
  EXPECT_EQ(sut_->bad_setpoints(), 2u);
}

TEST_F(VescDriveTest, AsksEachForFaultAndTimeOutInTurn) {
  make(with_motors(2));
  Texts questions;
  for (int i = 0; i < 20; ++i) {
    for (const std::string& text : send_all({}, false)) {
      if (text.substr(0, 6) == "000008") questions.push_back(text);
    }
  }
  EXPECT_EQ(questions, (Texts{"00000815#0A003200008000", "00000816#0A003200008000",
                              "00000815#0A003200200000", "00000816#0A003200200000"}));
}

TEST_F(VescDriveTest, ReadsStatus) {
  make(with_motors(2));
  hear({"00000916#0000508C007B0041", "00001016#00FA01F400140000", "00001B16#0000000000A0"});
  const DriveFeedback& feedback = sut_->feedback()[1];
  EXPECT_NEAR(feedback.speed_rad_s, -20620.0 / 7 * 2 * M_PI / 60, 1e-9);  // reversed
  EXPECT_NEAR(feedback.current_a, 12.3, 1e-9);
  EXPECT_NEAR(feedback.temperature_k, 298.15, 1e-9);
  EXPECT_NEAR(feedback.voltage_v, 16, 1e-9);
  EXPECT_TRUE(std::isnan(sut_->feedback()[0].voltage_v));
}

TEST_F(VescDriveTest, ReadyOnlyOnceTheTimeOutHasBeenSeen) {
  make(with_motors(1));
  const std::string status = "00000915#0000000000000000";
  hear({status, answer(0x15, true, 1)});  // too early: it has not yet been left alone
  idle(110, {status, kWell});
  EXPECT_TRUE(health().all_alive);
  EXPECT_FALSE(health().all_ready);
  EXPECT_TRUE(health().guards_itself);
  EXPECT_STREQ(health().trouble, "its own time-out has not yet been seen");
  hear({answer(0x15, true, 0)});
  EXPECT_FALSE(health().all_ready);
  hear({answer(0x15, true, 1)});
  EXPECT_TRUE(health().all_ready);
  EXPECT_EQ(health().first_bad, -1);
}

TEST_F(VescDriveTest, AVescThatNeverTimesOutIsUnguarded) {
  make(with_motors(1));
  idle(450, {kStatus, kWell, answer(0x15, true, 0)});
  EXPECT_FALSE(health().guards_itself);
  EXPECT_EQ(health().first_bad, 0);
  EXPECT_STREQ(health().trouble, "its own time-out does not pass");
  DriveConfig config = with_motors(1);
  config.vesc.accept_unguarded = true;
  make(config);
  idle(450, {kStatus, kWell, answer(0x15, true, 0)});
  EXPECT_TRUE(health().guards_itself);
  EXPECT_TRUE(health().all_ready);
}

TEST_F(VescDriveTest, OneThatWasAwayMustShowItsTimeOutAgain) {
  make(with_motors(1));
  const std::string status = "00000915#0000000000000000";
  idle(110, {status, kWell});
  hear({answer(0x15, true, 1)});
  EXPECT_TRUE(health().all_ready);
  idle(120, {});
  EXPECT_FALSE(health().all_alive);
  idle(1, {status, kWell});
  EXPECT_TRUE(health().all_alive);
  EXPECT_FALSE(health().all_ready);
  EXPECT_TRUE(health().guards_itself);  // it gets its time to show it
}

TEST_F(VescDriveTest, TellsFaultsInWords) {
  make(with_motors(2));
  const Texts status = {"00000915#0000000000000000", "00000916#0000000000000000"};
  hear(status);
  hear({answer(0x16, false, 4)});
  send({}, false);
  EXPECT_TRUE(health().any_fault);
  EXPECT_EQ(sut_->feedback()[1].state, DriveState::kFault);
  EXPECT_EQ(sut_->feedback()[1].error_count, 1u);
  hear({kWell});
  idle(110, status);
  hear({answer(0x15, true, 1)});
  EXPECT_EQ(health().first_bad, 1);
  EXPECT_STREQ(health().trouble, "over-current");
  EXPECT_EQ(health().trouble_code, 4u);
  hear({answer(0x16, false, 0)});
  EXPECT_FALSE(health().any_fault);
}

TEST_F(VescDriveTest, IsNotReadyBeforeItsFaultIsKnown) {
  make(with_motors(1));
  idle(110, {kStatus});
  hear({answer(0x15, true, 1)});
  EXPECT_FALSE(health().all_ready);
  EXPECT_STREQ(health().trouble, "it has not yet told its fault");
  hear({answer(0x15, false, 0)});
  EXPECT_TRUE(health().all_ready);
}

// An old answer says nothing of now, be it a fault or none.
TEST_F(VescDriveTest, OneThatNoLongerTellsItsFaultIsNotAlive) {
  for (const int fault : {0, 4}) {
    make(with_motors(1));
    hear({kStatus, answer(0x15, false, fault)});
    idle(200, {kStatus});
    EXPECT_TRUE(health().all_alive);
    EXPECT_EQ(health().any_fault, fault != 0);
    idle(3, {kStatus});
    EXPECT_FALSE(health().all_alive);
    EXPECT_FALSE(health().any_fault);
    EXPECT_EQ(sut_->feedback()[0].state, DriveState::kUnknown);
    EXPECT_STREQ(health().trouble, "it no longer tells its fault");
    idle(1, {kStatus, answer(0x15, false, fault)});
    EXPECT_TRUE(health().all_alive);
    EXPECT_EQ(health().any_fault, fault != 0);
  }
}

TEST_F(VescDriveTest, CountsWhatIsMalformedAndIgnoresOthers) {
  make(with_motors(1));
  hear({"00000915#0000", "0000080A#1501", answer(0x15, true, 1) /* good */,
        "0000080A#15013300200000FF", "0000080A#1500320020000001"});
  EXPECT_EQ(sut_->malformed(), 4u);
  hear({"00000999#0000", "115#0000", "00010915#00", "0000080B#1501", "00000215#00"});
  EXPECT_EQ(sut_->malformed(), 4u);
}

// Changed bits, lengths and ids of good frames: nothing breaks, values stay what the bits say.
TEST_F(VescDriveTest, MutatedFramesDoNoHarm) {
  make(with_motors(3));
  Random random(7);
  const std::vector<CanFrame> good =
      frames_from({"00000915#0000508C007B0041", "00001016#00FA01F400140000",
                   "00001B17#0000000000A00000", answer(0x15, true, 1), answer(0x16, false, 4)});
  for (int i = 0; i < 20000; ++i) {
    CanFrame frame = good[static_cast<std::size_t>(random.uniform() * 5)];
    for (int bits = static_cast<int>(random.uniform() * 4); bits > 0; --bits) {
      frame.data[static_cast<std::size_t>(random.uniform() * 8)] ^=
          static_cast<std::uint8_t>(1u << static_cast<int>(random.uniform() * 8));
    }
    if (random.uniform() < 0.2) frame.length = static_cast<std::uint8_t>(random.uniform() * 12);
    if (random.uniform() < 0.2) frame.id ^= 1u << static_cast<int>(random.uniform() * 29);
    if (random.uniform() < 0.05) frame.extended = !frame.extended;
    sut_->receive(frame, at_ms(ms_));
    if (i % 10 == 0) send({0.1, 0.2, 0.3}, i % 20 == 0);
    const DriveGroupHealth now = health();
    EXPECT_GE(now.first_bad, -1);
    EXPECT_LT(now.first_bad, 3);
    EXPECT_NE(now.trouble, nullptr);
  }
}

TEST_F(VescDriveTest, RefusesAConfigThatDoesNotFitTogether) {
  const auto refused = [](auto&& change, const char* why) {
    DriveConfig config = with_motors(2);
    change(config);
    const auto made = make_drive_group(config);
    ASSERT_FALSE(made) << why;
    EXPECT_NE(made.error().text.find(why), std::string::npos) << made.error().text;
  };
  refused([](DriveConfig& c) { c.motors.clear(); }, "no motor");
  refused([](DriveConfig& c) { c.motors[1].node_id = 0x15; }, "also that of motor 1");
  refused([](DriveConfig& c) { c.motors[1].node_id = 10; }, "own_node_id");
  refused([](DriveConfig& c) { c.motors[1].node_id = 0; }, "1 to 127");
  refused([](DriveConfig& c) { c.vesc.mode = "steam"; }, "steam");
  refused([](DriveConfig& c) { c.motors[0].pole_pairs = 0; }, "pole_pairs");
}

TEST_F(VescDriveTest, WantsTheStatusOfItsOwnAndTheAnswers) {
  const std::vector<CanFilter> filters = wanted_frames(with_motors(2));
  const auto wants = [&](const char* text) {
    const CanFrame frame = frames_from({text})[0];
    return std::any_of(filters.begin(), filters.end(),
                       [&](const CanFilter& filter) { return filter.matches(frame); });
  };
  EXPECT_TRUE(wants("00000915#00"));
  EXPECT_TRUE(wants("00001B16#00"));
  EXPECT_TRUE(wants("0000080A#00"));
  EXPECT_FALSE(wants("00000917#00"));
  EXPECT_FALSE(wants("00000815#00"));
  EXPECT_FALSE(wants("115#00"));
}

}  // namespace
}  // namespace gannet::hal
