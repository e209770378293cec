#include "hal/drive/odrive_drive.hpp"

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

constexpr TimePoint at_ms(std::int64_t ms) { return TimePoint(std::chrono::milliseconds(ms)); }
constexpr const char* kWatchdog = "00000001";  // low byte first
constexpr const char* kNone = "00000000";

// Node 3: ids 060 to 07F.
DriveConfig with_motors(int motors) {
  DriveConfig config;
  config.kind = "odrive";
  for (int i = 0; i < motors; ++i) {
    config.motors.push_back(
        {.node_id = 3 + i, .reversed = i % 2 == 1, .full_speed_rad_s = 8 * M_PI});  // 4 turns/s
  }
  return config;
}

std::string heartbeat(int node, const char* error, int state) {
  char text[40];
  std::snprintf(text, sizeof text, "%03X#%s%02X000000", static_cast<unsigned>(node << 5 | 1), error,
                static_cast<unsigned>(state));
  return text;
}
std::string estimates(int node) {
  char text[40];
  std::snprintf(text, sizeof text, "%03X#0000000000000000", static_cast<unsigned>(node << 5 | 9));
  return text;
}

class OdriveDriveTest : public testing::Test {
 protected:
  void make(const DriveConfig& config) { sut_ = std::move(*OdriveDrive::create(config)); }
  void hear(const Texts& texts) {
    for (const CanFrame& frame : frames_from(texts)) sut_->receive(frame, at_ms(ms_));
  }
  // One cycle of 5 ms.
  Texts send(double value, bool enable) {
    const std::vector<DriveSetpoint> setpoints(static_cast<std::size_t>(sut_->size()),
                                               DriveSetpoint{value});
    std::vector<CanFrame> out(static_cast<std::size_t>(sut_->max_frames()));
    const int n = sut_->send(setpoints, enable, at_ms(ms_), out);
    ms_ += 5;
    return texts_of(std::span(out).first(static_cast<std::size_t>(n)));
  }
  // What is sent in some cycles, hearing the same in each.
  Texts run(int cycles, bool enable, const Texts& heard, double value = 0.5) {
    Texts all;
    for (int i = 0; i < cycles; ++i) {
      hear(heard);
      for (const std::string& text : send(value, enable)) all.push_back(text);
    }
    return all;
  }
  // Alive, its watchdog seen.
  void make_ready(int motors) {
    make(with_motors(motors));
    Texts heard;
    for (int i = 0; i < motors; ++i) {
      heard.push_back(estimates(3 + i));
      heard.push_back(heartbeat(3 + i, kWatchdog, 1));
    }
    run(10, false, heard);
    ASSERT_TRUE(health().all_ready);
  }
  DriveGroupHealth health() const { return sut_->health(at_ms(ms_)); }

  std::unique_ptr<OdriveDrive> sut_;
  std::int64_t ms_ = 1000;
};

TEST_F(OdriveDriveTest, AsksForIdleOnceThenKeepsSilent) {
  make(with_motors(1));
  EXPECT_EQ(run(400, false, {heartbeat(3, kNone, 1), estimates(3)}), (Texts{"067#01000000"}));
}

// One frame may be lost, or refused by the bus; what it said before is no answer.
TEST_F(OdriveDriveTest, AsksForIdleInEachCycleUntilANewerHeartbeatSaysIt) {
  make_ready(1);
  send(0.5, true);
  run(10, true, {heartbeat(3, kNone, 8), estimates(3)});
  hear({heartbeat(3, kNone, 1)});
  EXPECT_EQ(run(20, false, {estimates(3)}), Texts(20, "067#01000000"));
  EXPECT_TRUE(run(100, false, {heartbeat(3, kNone, 1), estimates(3)}).empty());
}

TEST_F(OdriveDriveTest, AsksOneThatSaysNothingForIdleMoreSeldomAfterAWhile) {
  make_ready(1);
  send(0.5, true);
  run(10, true, {heartbeat(3, kNone, 8), estimates(3)});
  const Texts sent = run(61 + 400, false, {});  // 0.3 s, then 2 s
  EXPECT_EQ(std::count(sent.begin(), sent.end(), "067#01000000"), 61 + 20);
}

TEST_F(OdriveDriveTest, EntersClosedLoopThenCommandsSpeed) {
  make_ready(1);
  EXPECT_EQ(send(0.5, true),
            (Texts{"078#", "06B#0200000002000000", "06D#0000000000000000", "067#08000000"}));
  EXPECT_EQ(send(0.5, true),  // feeds the watchdog
            (Texts{"06B#0200000002000000", "06D#0000000000000000"}));
  hear({heartbeat(3, kNone, 8)});
  EXPECT_EQ(send(0.5, true), (Texts{"06D#0000004000000000"}));    // 2 turns/s
  EXPECT_EQ(send(-0.25, true), (Texts{"06D#000080BF00000000"}));  // −1
  EXPECT_EQ(send(9, true), (Texts{"06D#0000804000000000"}));      // 4
  EXPECT_EQ(send(std::numeric_limits<double>::quiet_NaN(), true), (Texts{"06D#0000000000000000"}));
  EXPECT_EQ(sut_->bad_setpoints(), 1u);
  EXPECT_EQ(sut_->feedback()[0].state, DriveState::kEnabled);
  EXPECT_EQ(send(0.5, false), (Texts{"067#01000000"}));
}

TEST_F(OdriveDriveTest, AReversedMotorTurnsTheOtherWay) {
  make_ready(2);
  send(0.5, true);
  hear({heartbeat(3, kNone, 8), heartbeat(4, kNone, 8)});
  EXPECT_EQ(send(0.5, true), (Texts{"06D#0000004000000000", "08D#000000C000000000"}));
  hear({"089#00000000000000C0"});  // −2 turns/s
  send(0.5, true);
  EXPECT_NEAR(sut_->feedback()[1].speed_rad_s, 4 * M_PI, 1e-6);
}

TEST_F(OdriveDriveTest, DirectModeIsPassthrough) {
  DriveConfig config = with_motors(1);
  config.odrive.input_mode = "direct";
  make(config);
  EXPECT_EQ(send(0, true)[0], "06B#0200000001000000");
}

TEST_F(OdriveDriveTest, AnAxisThatStaysInClosedLoopIsStoppedByEstop) {
  make_ready(1);
  const Texts sent = run(100, false, {heartbeat(3, kNone, 8), estimates(3)});
  EXPECT_GE(std::count(sent.begin(), sent.end(), "067#01000000"), 4);
  EXPECT_GE(std::count(sent.begin(), sent.end(), "062#"), 1);
}

TEST_F(OdriveDriveTest, ReadsWhatTheDriveSays) {
  make(with_motors(1));
  EXPECT_TRUE(std::isnan(sut_->feedback()[0].current_a));
  hear({"069#0000000000000040", "074#0000000000002041", "077#0000804100000000",
        "075#0000C84100000000"});
  send(0, false);
  const DriveFeedback& feedback = sut_->feedback()[0];
  EXPECT_NEAR(feedback.speed_rad_s, 4 * M_PI, 1e-6);
  EXPECT_EQ(feedback.current_a, 10);
  EXPECT_EQ(feedback.voltage_v, 16);
  EXPECT_NEAR(feedback.temperature_k, 298.15, 1e-4);
}

TEST_F(OdriveDriveTest, ReadyOnlyOnceTheWatchdogHasBeenSeen) {
  make(with_motors(1));
  run(20, false, {heartbeat(3, kNone, 1), estimates(3)});
  EXPECT_TRUE(health().all_alive);
  EXPECT_FALSE(health().all_ready);
  EXPECT_TRUE(health().guards_itself);
  EXPECT_STREQ(health().trouble, "its watchdog has not yet been seen to expire");
  run(1, false, {heartbeat(3, kWatchdog, 1), estimates(3)});
  EXPECT_TRUE(health().all_ready);
  EXPECT_FALSE(health().any_fault);  // that error is what is wanted
}

TEST_F(OdriveDriveTest, AnAxisWithoutAWatchdogIsUnguarded) {
  make(with_motors(1));
  run(250, false, {heartbeat(3, kNone, 1), estimates(3)});
  EXPECT_FALSE(health().guards_itself);
  EXPECT_STREQ(health().trouble, "its watchdog does not expire");
  DriveConfig config = with_motors(1);
  config.odrive.accept_unguarded = true;
  make(config);
  run(250, false, {heartbeat(3, kNone, 1), estimates(3)});
  EXPECT_TRUE(health().guards_itself);
  EXPECT_TRUE(health().all_ready);
}

TEST_F(OdriveDriveTest, Firmware05HasItsWatchdogElsewhere) {
  DriveConfig config = with_motors(1);
  config.odrive.firmware = "0.5";
  make(config);
  run(20, false, {heartbeat(3, kWatchdog, 1), estimates(3)});
  EXPECT_FALSE(health().all_ready);
  EXPECT_TRUE(health().any_fault);
  run(20, false, {heartbeat(3, "00080000", 1), estimates(3)});
  EXPECT_TRUE(health().all_ready);
  EXPECT_FALSE(health().any_fault);
}

TEST_F(OdriveDriveTest, AnErrorWhileEnabledTripsUntilEnableIsTakenAway) {
  make_ready(1);
  send(0.5, true);
  run(10, true, {heartbeat(3, kNone, 8), estimates(3)});
  hear({heartbeat(3, "20000000", 1)});
  EXPECT_EQ(send(0.5, true), (Texts{"067#01000000"}));
  EXPECT_TRUE(health().any_fault);
  EXPECT_STREQ(health().trouble, "gate driver");
  EXPECT_EQ(health().trouble_code, 0x20u);
  const Texts sent = run(100, true, {heartbeat(3, "20000000", 1), estimates(3)});
  EXPECT_TRUE(sent.empty());
  run(2, false, {heartbeat(3, "20000000", 1)});
  EXPECT_TRUE(health().any_fault);  // the error is still there
  sut_->reset_faults(at_ms(ms_));
  EXPECT_EQ(send(0, false), (Texts{"078#"}));
  run(1, false, {heartbeat(3, kNone, 1)});
  EXPECT_FALSE(health().any_fault);
}

TEST_F(OdriveDriveTest, TheWatchdogExpiringWhileEnabledIsAFault) {
  make_ready(1);
  send(0.5, true);
  run(10, true, {heartbeat(3, kNone, 8), estimates(3)});
  run(1, true, {heartbeat(3, kWatchdog, 1)});
  EXPECT_TRUE(health().any_fault);
  EXPECT_STREQ(health().trouble, "watchdog expired");
  run(2, false, {heartbeat(3, kWatchdog, 1), estimates(3)});
  EXPECT_FALSE(health().any_fault);
}

TEST_F(OdriveDriveTest, OneThatDoesNotEnterClosedLoopIsAFault) {
  make_ready(1);
  run(150, true, {heartbeat(3, kNone, 1), estimates(3)});
  EXPECT_FALSE(health().any_fault);
  run(60, true, {heartbeat(3, kNone, 1), estimates(3)});
  EXPECT_TRUE(health().any_fault);
  EXPECT_STREQ(health().trouble, "it did not enter closed loop");
}

TEST_F(OdriveDriveTest, OneThatFallsSilentIsNotAlive) {
  make_ready(2);
  run(120, false, {heartbeat(3, kNone, 1), estimates(3), estimates(4)});  // no heartbeat of 4
  EXPECT_FALSE(health().all_alive);
  EXPECT_EQ(health().first_bad, 1);
  EXPECT_EQ(sut_->feedback()[1].state, DriveState::kUnknown);
}

TEST_F(OdriveDriveTest, CountsWhatIsMalformedAndIgnoresOthers) {
  make(with_motors(1));
  hear({"061#00", "069#0000", "074#"});
  EXPECT_EQ(sut_->malformed(), 3u);
  hear({"081#00", "067#01000000", "00000061#00", "07F#00"});
  EXPECT_EQ(sut_->malformed(), 3u);
}

TEST_F(OdriveDriveTest, MutatedFramesDoNoHarm) {
  make(with_motors(3));
  Random random(7);
  const std::vector<CanFrame> good =
      frames_from({heartbeat(3, kWatchdog, 1), heartbeat(4, kNone, 8), estimates(3), estimates(5),
                   "074#0000000000002041", "0B7#0000804100000000", "083#2000000000000001"});
  for (int i = 0; i < 20000; ++i) {
    CanFrame frame = good[static_cast<std::size_t>(random.uniform() * 7)];
    for (int bits = static_cast<int>(random.uniform() * 4); bits > 0; --bits) {
      frame.data[static_cast<std::size_t>(random.uniform() * 8)] ^=
          static_cast<std::uint8_t>(1u << static_cast<int>(random.uniform() * 8));
    }
    if (random.uniform() < 0.2) frame.length = static_cast<std::uint8_t>(random.uniform() * 12);
    if (random.uniform() < 0.2) frame.id ^= 1u << static_cast<int>(random.uniform() * 11);
    if (random.uniform() < 0.05) frame.extended = !frame.extended;
    sut_->receive(frame, at_ms(ms_));
    if (i % 10 == 0) send(0.1, i % 2000 < 1000);
    if (i % 500 == 0) sut_->reset_faults(at_ms(ms_));
    const DriveGroupHealth now = health();
    EXPECT_GE(now.first_bad, -1);
    EXPECT_LT(now.first_bad, 3);
    EXPECT_NE(now.trouble, nullptr);
  }
}

TEST_F(OdriveDriveTest, RefusesAConfigThatDoesNotFitTogether) {
  const auto refused = [](auto&& change, const char* why) {
    DriveConfig config = with_motors(2);
    change(config);
    const auto made = make_drive_group(config);
    ASSERT_FALSE(made) << why;
    EXPECT_NE(made.error().text.find(why), std::string::npos) << made.error().text;
  };
  refused([](DriveConfig& c) { c.motors.clear(); }, "no motor");
  refused([](DriveConfig& c) { c.motors[1].node_id = 3; }, "also that of motor 1");
  refused([](DriveConfig& c) { c.motors[1].node_id = 64; }, "1 to 63");
  refused([](DriveConfig& c) { c.motors[1].full_speed_rad_s = 0; }, "full_speed_rad_s");
  refused([](DriveConfig& c) { c.odrive.firmware = "9"; }, "firmware");
  refused([](DriveConfig& c) { c.odrive.input_mode = "steam"; }, "steam");
}

TEST_F(OdriveDriveTest, WantsWhatItsNodesSay) {
  const std::vector<CanFilter> filters = wanted_frames(with_motors(1));
  const auto wants = [&](const char* text) {
    const CanFrame frame = frames_from({text})[0];
    return std::any_of(filters.begin(), filters.end(),
                       [&](const CanFilter& filter) { return filter.matches(frame); });
  };
  EXPECT_TRUE(wants("061#"));
  EXPECT_TRUE(wants("069#"));
  EXPECT_FALSE(wants("081#"));
  EXPECT_FALSE(wants("06D#"));
  EXPECT_FALSE(wants("00000061#"));
}

}  // namespace
}  // namespace gannet::hal
