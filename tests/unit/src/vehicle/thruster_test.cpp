#include "src/vehicle/thruster.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace gannet::vehicle {
namespace {

CurveConfig asymmetric() {
  CurveConfig curve;
  curve.max_forward_n = 51.4;
  curve.max_backward_n = 39.9;
  return curve;
}

TEST(ThrusterCurve, goes_there_and_back) {
  const CurveConfig sut = asymmetric();
  for (double thrust = -39.9; thrust <= 51.4; thrust += 0.1) {
    EXPECT_NEAR(thrust_of(sut, command_for(sut, thrust)), thrust, 1e-4) << thrust;
  }
  for (double command = -1; command <= 1; command += 0.01) {
    if (std::abs(command) < 0.08) continue;
    EXPECT_NEAR(command_for(sut, thrust_of(sut, command)), command, 1e-9) << command;
  }
}

TEST(ThrusterCurve, rests_in_the_dead_band_and_is_weaker_backward) {
  const CurveConfig sut = asymmetric();
  EXPECT_EQ(thrust_of(sut, 0.07), 0);
  EXPECT_EQ(thrust_of(sut, -0.07), 0);
  EXPECT_EQ(command_for(sut, 0), 0);
  EXPECT_DOUBLE_EQ(thrust_of(sut, 1), 51.4);
  EXPECT_DOUBLE_EQ(thrust_of(sut, -1), -39.9);
  EXPECT_GT(command_for(sut, -20), -1);
  EXPECT_LT(command_for(sut, -20), -command_for(sut, 20));
}

TEST(ThrusterCurve, never_commands_more_than_its_limit) {
  CurveConfig sut = asymmetric();
  sut.limit = 0.5;
  EXPECT_EQ(command_for(sut, 1000), 0.5);
  EXPECT_EQ(command_for(sut, -1000), -0.5);
  EXPECT_EQ(thrust_of(sut, 1), thrust_of(sut, 0.5));
}

// Blue Robotics' data at 12 V, as the cubic that their users fitted to it has it: 1 kgf at 1672 µs,
// 2 kgf at 1765 µs, 3.71 kgf at most; no thrust below 1536 µs.
TEST(ThrusterCurve, follows_the_published_t200_points) {
  CurveConfig sut;
  sut.max_forward_n = 3.71 * 9.80665;
  sut.dead_band = 0.09;
  EXPECT_NEAR(thrust_of(sut, (1672.0 - 1500) / 400), 1 * 9.80665, 0.4);
  EXPECT_NEAR(thrust_of(sut, (1765.0 - 1500) / 400), 2 * 9.80665, 0.4);
}

TEST(Thrusters, refuse_what_is_no_table) {
  RovConfig config;
  config.frame = "blimp";
  EXPECT_FALSE(thrusters_of(config));
  config.frame = "custom";
  EXPECT_FALSE(thrusters_of(config));
  config.thrusters.resize(1);
  EXPECT_TRUE(thrusters_of(config));
  config.thrusters[0].direction = {0, 0, 0};
  EXPECT_FALSE(thrusters_of(config));
  config.thrusters[0].direction = {1, 0};
  EXPECT_FALSE(thrusters_of(config));
}

}  // namespace
}  // namespace gannet::vehicle
