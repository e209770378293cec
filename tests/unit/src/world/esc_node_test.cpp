#include "src/world/esc_node.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "hal/can/can_text.hpp"
#include "hal/drive/dronecan_esc_drive.hpp"
#include "tests/unit/src/world/drive_loop.hpp"

namespace gannet::world {
namespace {

using namespace hal::dronecan;

constexpr TimePoint at_ms(std::int64_t ms) { return TimePoint(std::chrono::milliseconds(ms)); }

hal::DriveConfig with_motors(int motors) {
  hal::DriveConfig config;
  config.dronecan.esc_timeout_s = EscBehaviour{}.command_timeout_s;
  for (int i = 0; i < motors; ++i) {
    config.motors.push_back({.index = i, .node_id = 21 + i, .reversed = i % 2 == 1});
  }
  return config;
}

// A drive and its nodes on one wire, 5 ms cycles.
class EscNodesTest : public testing::Test {
 protected:
  void make(const hal::DriveConfig& config, const EscBehaviour& behaviour = {}) {
    drive_ = std::move(*hal::DroneCanEscDrive::create(config));
    sut_ = std::make_unique<EscNodes>(config, behaviour, 1);
  }
  void run(int cycles, const std::vector<double>& values, bool enable = true,
           bool daemon_lives = true) {
    std::vector<hal::DriveSetpoint> setpoints;
    for (double value : values) setpoints.push_back({value});
    std::vector<hal::CanFrame> sent(static_cast<std::size_t>(drive_->max_frames()));
    for (int i = 0; i < cycles; ++i, ms_ += 5) {
      int n = 0;
      if (daemon_lives) n = drive_->send(setpoints, enable, at_ms(ms_), sent);
      heard_.clear();
      commanded_ =
          sut_->step(at_ms(ms_), std::span(sent).first(static_cast<std::size_t>(n)), heard_);
      frames_ += static_cast<int>(heard_.size());
      for (const hal::CanFrame& frame : heard_) {
        log_ += hal::to_text(frame) + '\n';
        if (daemon_lives) drive_->receive(frame, at_ms(ms_));
      }
    }
  }
  std::vector<double> commanded() const { return {commanded_.begin(), commanded_.end()}; }
  hal::DriveGroupHealth health() const { return drive_->health(at_ms(ms_)); }

  std::unique_ptr<hal::DroneCanEscDrive> drive_;
  std::unique_ptr<EscNodes> sut_;
  std::vector<hal::CanFrame> heard_;
  std::span<const double> commanded_;
  std::string log_;
  int frames_ = 0;
  std::int64_t ms_ = 0;
};

TEST_F(EscNodesTest, CommandsArriveByTheVehiclesSign) {
  make(with_motors(8));
  run(1, {1, 1, -1, -1, 0.5, 0.5, 0, 0});
  const double wanted[] = {1, 1, -1, -1, 0.5, 0.5, 0, 0};
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(commanded()[i], wanted[i], 1e-4) << i;
}

TEST_F(EscNodesTest, TheDriveFindsAllNodesAliveAndWell) {
  make(with_motors(6));
  run(40, std::vector<double>(6, 0.1));
  EXPECT_TRUE(health().all_alive);
  EXPECT_FALSE(health().any_fault);
  EXPECT_EQ(drive_->malformed(), 0u);
  EXPECT_EQ(drive_->transfers().lost + drive_->transfers().repeated, 0u);
  for (const auto& feedback : drive_->feedback()) {
    EXPECT_EQ(feedback.state, hal::DriveState::kEnabled);
  }
}

TEST_F(EscNodesTest, NodesSayWhoTheyAre) {
  make(with_motors(3));
  run(60, {0, 0, 0});
  for (const auto& node : drive_->nodes()) {
    ASSERT_TRUE(node.has_info) << int{node.id};
    EXPECT_EQ(std::string(node.info.name.begin(), node.info.name.end()), "org.gannet.world.esc");
    EXPECT_EQ(node.info.unique_id[15], node.id);
  }
}

TEST_F(EscNodesTest, ThePlantsValuesComeBackAsFeedback) {
  hal::DriveConfig config = with_motors(2);
  config.motors[1].pole_pairs = 7;
  make(config);
  for (int motor : {0, 1}) {
    sut_->report(motor,
                 {.speed_rad_s = 150, .current_a = 3.5, .voltage_v = 16, .temperature_k = 300});
  }
  run(20, {0.5, 0.5});
  for (const auto& feedback : drive_->feedback()) {
    EXPECT_NEAR(feedback.speed_rad_s, 150, 0.1);
    EXPECT_EQ(feedback.current_a, 3.5);
    EXPECT_EQ(feedback.voltage_v, 16);
    EXPECT_EQ(feedback.temperature_k, 300);
  }
}

TEST_F(EscNodesTest, HeartbeatOnceASecondAndStatusAtItsRate) {
  make(with_motors(1), {.status_hz = 20});
  run(2000, {0});                                // 10 s
  constexpr int kNodeInfo = frames_of(41 + 20);  // with a name of 20 letters
  EXPECT_EQ(frames_, 10 + 200 * frames_of(14) + kNodeInfo);
}

TEST_F(EscNodesTest, WithoutCommandsTheMotorsStopByThemselves) {
  make(with_motors(2), {.command_timeout_s = 0.5});
  run(10, {1, 1});
  run(100, {}, true, false);  // the last command was 500 ms ago
  EXPECT_EQ(commanded()[0], 1);
  run(1, {}, true, false);
  EXPECT_EQ(commanded(), (std::vector<double>{0, 0}));
  run(1, {0.5, 0.5});
  EXPECT_NEAR(commanded()[0], 0.5, 1e-4);
}

TEST_F(EscNodesTest, DisabledMeansStop) {
  make(with_motors(2));
  run(2, {1, 1});
  run(1, {1, 1}, false);
  EXPECT_EQ(commanded(), (std::vector<double>{0, 0}));
}

TEST_F(EscNodesTest, AnEscThatNeedsArmingWaitsForIt) {
  make(with_motors(1), {.needs_arming = true});
  std::vector<hal::CanFrame> out;
  const auto raw = *hal::can_frame_from_text("0804060A#FF7CC0");
  EXPECT_EQ(sut_->step(at_ms(0), {&raw, 1}, out)[0], 0);
  run(1, {1});
  EXPECT_EQ(commanded()[0], 1);
}

TEST_F(EscNodesTest, ASilentNodeStopsAndIsMissed) {
  make(with_motors(2));
  run(200, {1, 1});
  sut_->faults(1).silent = true;
  run(102, {1, 1});
  EXPECT_EQ(commanded(), (std::vector<double>{1, 0}));
  EXPECT_FALSE(health().all_alive);
  EXPECT_EQ(health().first_bad, 1);
  sut_->faults(1).silent = false;
  run(220, {1, 1});
  EXPECT_TRUE(health().all_alive);
  EXPECT_EQ(commanded(), (std::vector<double>{1, 1}));
}

TEST_F(EscNodesTest, AFaultyNodeSaysSoAndStandsStill) {
  make(with_motors(2));
  run(200, {1, 1});
  sut_->faults(0).faulty = true;
  run(220, {1, 1});
  EXPECT_EQ(commanded(), (std::vector<double>{0, 1}));
  EXPECT_TRUE(health().any_fault);
  EXPECT_EQ(drive_->feedback()[0].state, hal::DriveState::kFault);
  EXPECT_EQ(drive_->feedback()[0].fault_code, 1);
  EXPECT_EQ(drive_->feedback()[0].error_count, 1u);
}

TEST_F(EscNodesTest, ALateNodesWordsArriveLate) {
  make(with_motors(1));
  sut_->faults(0).late = std::chrono::milliseconds(100);
  run(20, {0});
  EXPECT_EQ(frames_, 0);
  run(1, {0});
  EXPECT_GT(frames_, 0);
}

TEST_F(EscNodesTest, GarbageIsNotBelieved) {
  make(with_motors(2));
  sut_->report(0, {.voltage_v = 16});
  run(100, {0, 0});
  sut_->faults(0).garbage = 0.3;
  run(1000, {0, 0});
  EXPECT_GT(drive_->malformed(), 5u);
  EXPECT_EQ(drive_->feedback()[0].voltage_v, 16);  // whole transfers are guarded by their CRC
  EXPECT_TRUE(health().all_alive);
}

TEST_F(EscNodesTest, EscsOnOneNodeShareItsHeartbeatAndItsFaults) {
  hal::DriveConfig config;
  config.range = "pwm_centred";
  config.motors = {{.index = 0, .node_id = 30}, {.index = 1, .node_id = 30}};
  make(config);
  run(40, {0.5, -0.5});
  EXPECT_NEAR(commanded()[0], 0.5, 2e-4);
  EXPECT_NEAR(commanded()[1], -0.5, 2e-4);
  EXPECT_TRUE(health().all_alive);
  sut_->faults(1).silent = true;
  run(110, {0.5, -0.5});
  EXPECT_EQ(commanded(), (std::vector<double>{0, 0}));
}

TEST_F(EscNodesTest, TheSameSeedGivesTheSameFrames) {
  std::string logs[2];
  for (std::string& log : logs) {
    ms_ = 0;
    log_.clear();
    make(with_motors(4));
    sut_->faults(2).garbage = 0.5;
    run(300, {0.1, 0.2, 0.3, 0.4});
    log = log_;
  }
  EXPECT_GT(logs[0].size(), 1000u);
  EXPECT_EQ(logs[0], logs[1]);
}

// Twenty ESCs take six frames a command: one lost frame costs that command, not the next ones.
class EscsOnABadWire : public DriveLoop {};

TEST_F(EscsOnABadWire, TwentyEscsInOneCommandLiveWithLostAndRepeatedFrames) {
  const hal::DriveConfig config = with_motors(20);
  make(config, std::make_unique<EscNodes>(config, EscBehaviour{}, 1));
  loss_ = repeat_ = 0.05;
  make_ready();
  std::vector<double> values;
  for (int i = 0; i < 20; ++i) values.push_back(0.9 - 0.09 * i);
  int obeyed = 0;
  for (int i = 0; i < 400; ++i) {
    run(1, values, true);
    EXPECT_FALSE(health().any_fault);
    EXPECT_TRUE(health().all_alive);
    for (std::size_t motor = 0; i >= 40 && motor < 20; ++motor) {
      EXPECT_NEAR(throttle(motor), values[motor], 1e-3);
      ++obeyed;
    }
  }
  EXPECT_EQ(obeyed, 360 * 20);
  run(20, {}, false);
  for (const double value : throttles_) EXPECT_EQ(value, 0);
}

}  // namespace
}  // namespace gannet::world
