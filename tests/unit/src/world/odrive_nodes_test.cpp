#include "src/world/odrive_nodes.hpp"

#include <algorithm>
#include <cmath>

#include "src/world/thruster.hpp"
#include "tests/unit/src/world/drive_loop.hpp"

namespace gannet::world {
namespace {

hal::DriveConfig with_motors(int motors, const char* firmware = "0.6") {
  hal::DriveConfig config;
  config.kind = "odrive";
  config.odrive.firmware = firmware;
  for (int i = 0; i < motors; ++i) {
    config.motors.push_back({.node_id = 1 + i, .reversed = i % 2 == 1});
  }
  return config;
}

class OdriveNodesTest : public DriveLoop {
 protected:
  void make(const hal::DriveConfig& config, const OdriveBehaviour& behaviour = {}) {
    DriveLoop::make(config, std::make_unique<OdriveNodes>(config, behaviour, 1));
  }
};

TEST_F(OdriveNodesTest, TurnsAtTheSpeedThatWasAskedForByTheVehiclesSign) {
  for (const char* firmware : {"0.5", "0.6"}) {
    make(with_motors(2, firmware));
    make_ready();
    EXPECT_FALSE(nodes_->armed());
    run(40, {0.5, -0.25}, true);  // of 300 rad/s
    EXPECT_FALSE(health().any_fault) << health().trouble;
    EXPECT_NEAR(steady_speed_rad_s(throttle(0)), 150, 0.1);
    EXPECT_NEAR(steady_speed_rad_s(throttle(1)), -75, 0.1);
    EXPECT_TRUE(nodes_->armed());
    run(1, {0.5, -0.25}, false);
    for (const double value : throttles_) EXPECT_EQ(value, 0);
    EXPECT_FALSE(nodes_->armed());
  }
}

TEST_F(OdriveNodesTest, CanBeEnabledAgainAndAgain) {
  make(with_motors(1));
  make_ready();
  for (int i = 0; i < 3; ++i) {
    run(60, {0.5}, true);
    EXPECT_NE(throttle(0), 0);
    EXPECT_FALSE(health().any_fault) << health().trouble;
    run(60, {0.5}, false);
    EXPECT_EQ(throttle(0), 0);
  }
}

TEST_F(OdriveNodesTest, ThePlantsValuesComeBackAsFeedback) {
  make(with_motors(2));
  nodes_->report(1,
                 {.speed_rad_s = -120, .current_a = 3.4, .voltage_v = 15.8, .temperature_k = 310});
  run(50, {}, false);
  const hal::DriveFeedback& feedback = drive_->feedback()[1];
  EXPECT_NEAR(feedback.speed_rad_s, -120, 1e-4);
  EXPECT_NEAR(feedback.current_a, 3.4, 1e-5);
  EXPECT_NEAR(feedback.voltage_v, 15.8, 1e-5);
  EXPECT_NEAR(feedback.temperature_k, 310, 1e-4);
}

TEST_F(OdriveNodesTest, WithoutCommandsTheMotorsStopByThemselves) {
  make(with_motors(2));
  make_ready();
  run(60, {0.5, 0.5}, true);
  run(95, {}, true, false);
  EXPECT_NE(throttle(0), 0);
  run(10, {}, true, false);
  EXPECT_EQ(throttle(0), 0);
}

TEST_F(OdriveNodesTest, OneWithoutAWatchdogIsFoundOut) {
  make(with_motors(2), {.watchdog_s = 0});
  run(400, {}, false);
  EXPECT_FALSE(health().guards_itself);
}

TEST_F(OdriveNodesTest, AFaultLastsUntilAPersonsReset) {
  make(with_motors(3));
  make_ready();
  run(60, {0.5, 0.5, 0.5}, true);
  nodes_->faults(1).faulty = true;
  run(30, {0.5, 0.5, 0.5}, true);
  EXPECT_EQ(throttle(1), 0);
  EXPECT_TRUE(health().any_fault);
  EXPECT_EQ(health().first_bad, 1);
  EXPECT_STREQ(health().trouble, "gate driver");
  nodes_->faults(1) = {};
  run(100, {}, false);
  EXPECT_TRUE(health().any_fault);
  drive_->reset_faults(now());
  run(200, {}, false);
  EXPECT_FALSE(health().any_fault);
  run(60, {0.5, 0.5, 0.5}, true);
  EXPECT_NE(throttle(1), 0);
}

TEST_F(OdriveNodesTest, ASilentOneStopsAndIsMissed) {
  make(with_motors(2));
  make_ready();
  run(60, {0.5, 0.5}, true);
  nodes_->faults(0).silent = true;
  run(120, {0.5, 0.5}, true);
  EXPECT_FALSE(health().all_alive);
  EXPECT_EQ(health().first_bad, 0);
  EXPECT_EQ(throttle(0), 0);
  EXPECT_NE(throttle(1), 0);
}

TEST_F(OdriveNodesTest, LateWordsAreBorne) {
  make(with_motors(1));
  nodes_->faults(0).late = std::chrono::milliseconds(80);
  make_ready();
  run(100, {0.5}, true);
  EXPECT_FALSE(health().any_fault) << health().trouble;
  EXPECT_NE(throttle(0), 0);
}

// A fifth of all frames lost, as many said twice.
TEST_F(OdriveNodesTest, RunsOnOverABadWire) {
  make(with_motors(8));
  loss_ = repeat_ = 0.2;
  make_ready();
  int still = 0;
  for (int i = 0; i < 400; ++i) {
    run(1, std::vector<double>(8, 0.5), true);
    EXPECT_FALSE(health().any_fault) << health().trouble;
    EXPECT_TRUE(health().all_alive);
    if (i >= 200) still += static_cast<int>(std::count(throttles_.begin(), throttles_.end(), 0.0));
  }
  EXPECT_EQ(still, 0);
  run(80, {}, false);
  for (const double value : throttles_) EXPECT_EQ(value, 0);
}

TEST_F(OdriveNodesTest, TheSameSeedGivesTheSameFrames) {
  std::string logs[2];
  for (std::string& log : logs) {
    log_.clear();
    ms_ = 1000;
    make(with_motors(3));
    nodes_->faults(1).garbage = 0.5;
    run(300, {0.1, 0.2, 0.3}, true);
    log = log_;
  }
  EXPECT_EQ(logs[0], logs[1]);
  EXPECT_FALSE(logs[0].empty());
}

}  // namespace
}  // namespace gannet::world
