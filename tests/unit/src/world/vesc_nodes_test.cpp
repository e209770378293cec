#include "src/world/vesc_nodes.hpp"

#include <algorithm>
#include <cmath>

#include "src/world/thruster.hpp"
#include "tests/unit/src/world/drive_loop.hpp"

namespace gannet::world {
namespace {

hal::DriveConfig with_motors(int motors, const char* mode = "duty") {
  hal::DriveConfig config;
  config.kind = "vesc";
  config.vesc.mode = mode;
  for (int i = 0; i < motors; ++i) {
    config.motors.push_back({.node_id = 21 + i, .reversed = i % 2 == 1, .pole_pairs = 7});
  }
  return config;
}

class VescNodesTest : public DriveLoop {
 protected:
  void make(const hal::DriveConfig& config, const VescBehaviour& behaviour = {}) {
    DriveLoop::make(config, std::make_unique<VescNodes>(config, behaviour, 1));
  }
};

TEST_F(VescNodesTest, CommandsArriveByTheVehiclesSign) {
  for (const char* mode : {"duty", "current"}) {
    make(with_motors(3, mode));
    make_ready();
    EXPECT_FALSE(nodes_->armed());
    run(2, {0.5, -0.25, 1}, true);
    EXPECT_NEAR(throttle(0), 0.5, 1e-4);
    EXPECT_NEAR(throttle(1), -0.25, 1e-4);
    EXPECT_NEAR(throttle(2), 1, 1e-4);
    EXPECT_TRUE(nodes_->armed());
    run(1, {0.5, -0.25, 1}, false);
    for (const double value : throttles_) EXPECT_EQ(value, 0);
    EXPECT_FALSE(nodes_->armed());
  }
}

TEST_F(VescNodesTest, SpeedModeTurnsAtTheSpeedThatWasAskedFor) {
  make(with_motors(2, "speed"));
  make_ready();
  run(1, {0.5, -0.5}, true);  // of 300 rad/s
  EXPECT_NEAR(steady_speed_rad_s(throttle(0)), 150, 0.1);
  EXPECT_NEAR(steady_speed_rad_s(throttle(1)), -150, 0.1);
}

TEST_F(VescNodesTest, ThePlantsValuesComeBackAsFeedback) {
  make(with_motors(2));
  nodes_->report(1,
                 {.speed_rad_s = -120, .current_a = 3.4, .voltage_v = 15.8, .temperature_k = 310});
  run(20, {}, false);
  const hal::DriveFeedback& feedback = drive_->feedback()[1];
  EXPECT_NEAR(feedback.speed_rad_s, -120, 0.01);
  EXPECT_NEAR(feedback.current_a, 3.4, 1e-9);
  EXPECT_NEAR(feedback.voltage_v, 15.8, 1e-9);
  EXPECT_NEAR(feedback.temperature_k, 310, 0.06);
}

TEST_F(VescNodesTest, WithoutCommandsTheMotorsStopByThemselves) {
  make(with_motors(2));
  make_ready();
  run(10, {0.5, 0.5}, true);
  run(195, {}, true, false);
  EXPECT_NE(throttle(0), 0);
  run(10, {}, true, false);
  EXPECT_EQ(throttle(0), 0);
  EXPECT_FALSE(nodes_->armed());
}

TEST_F(VescNodesTest, OneWithoutATimeOutIsFoundOut) {
  make(with_motors(2), {.timeout_s = 0});
  run(800, {}, false);
  EXPECT_FALSE(health().guards_itself);
}

TEST_F(VescNodesTest, ATimeOutThatIsTooLongIsFoundOut) {
  make(with_motors(1), {.timeout_s = 3});
  run(500, {}, false);
  EXPECT_FALSE(health().guards_itself);
}

TEST_F(VescNodesTest, AFaultyOneSaysSoAndStandsStill) {
  make(with_motors(3));
  make_ready();
  run(10, {0.5, 0.5, 0.5}, true);
  nodes_->faults(1).faulty = true;
  run(30, {0.5, 0.5, 0.5}, true);
  EXPECT_EQ(throttle(1), 0);
  EXPECT_TRUE(health().any_fault);
  EXPECT_EQ(health().first_bad, 1);
  EXPECT_STREQ(health().trouble, "over-current");
  nodes_->faults(1) = {};
  run(30, {0.5, 0.5, 0.5}, true);
  EXPECT_FALSE(health().any_fault);
}

TEST_F(VescNodesTest, ASilentOneStopsAndIsMissed) {
  make(with_motors(2));
  make_ready();
  run(10, {0.5, 0.5}, true);
  nodes_->faults(0).silent = true;
  run(110, {0.5, 0.5}, true);
  EXPECT_FALSE(health().all_alive);
  EXPECT_EQ(health().first_bad, 0);
  run(110, {0.5, 0.5}, true);
  EXPECT_EQ(throttle(0), 0);
  EXPECT_NE(throttle(1), 0);
}

TEST_F(VescNodesTest, LateWordsAndLostOnesAreBorne) {
  make(with_motors(2));
  nodes_->faults(0).late = std::chrono::milliseconds(80);
  nodes_->faults(1).garbage = 0.3;
  run(1200, {}, false);
  EXPECT_TRUE(health().all_alive);
  EXPECT_TRUE(health().all_ready);
}

// A fifth of all frames lost, as many said twice.
TEST_F(VescNodesTest, RunsOnOverABadWire) {
  make(with_motors(8));
  loss_ = repeat_ = 0.2;
  make_ready();
  int still = 0;
  for (int i = 0; i < 400; ++i) {
    run(1, std::vector<double>(8, 0.5), true);
    EXPECT_FALSE(health().any_fault) << health().trouble;
    EXPECT_TRUE(health().all_alive);
    if (i >= 100) still += static_cast<int>(std::count(throttles_.begin(), throttles_.end(), 0.0));
  }
  EXPECT_EQ(still, 0);
  run(80, {}, false);
  for (const double value : throttles_) EXPECT_EQ(value, 0);
}

TEST_F(VescNodesTest, TheSameSeedGivesTheSameFrames) {
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
