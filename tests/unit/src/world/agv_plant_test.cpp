#include "src/world/agv_plant.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "src/world/thruster.hpp"

namespace gannet::world {
namespace {

AgvPlantConfig exact() {
  AgvPlantConfig config;
  config.radius_error = {0, 0};
  config.track_error = 0;
  return config;
}

// Wheels' speeds, rad/s.
void drive(AgvPlant& plant, double left, double right) {
  plant.command(std::array{throttle_at_speed(left * 15), throttle_at_speed(right * 15)});
}

TEST(AgvPlant, drives_straight_at_its_wheels_speed_less_a_little_slip) {
  AgvPlant plant(exact());
  drive(plant, 8, 8);
  plant.advance(4);
  EXPECT_NEAR(plant.velocity().linear.x(), 0.8, 0.005);
  // Slip that holds against 1.5 % rolling resistance: 0.015 / 0.7 · 15 %.
  EXPECT_NEAR(plant.slip(0), 0.015 / 0.7 * 0.15, 1e-4);
  EXPECT_NEAR(plant.pose().translation.y(), 0, 1e-9);
  EXPECT_NEAR(plant.motor(0).speed_rad_s, 120, 1e-3);
}

TEST(AgvPlant, turns_on_the_spot_by_the_wheels_difference) {
  AgvPlant plant(exact());
  drive(plant, -2, 2);
  plant.advance(3);
  EXPECT_NEAR(plant.velocity().angular.z(), 2 * 2 * 0.1 / 0.5, 1e-3);
  EXPECT_NEAR(plant.pose().translation.norm(), 0, 1e-6);
}

TEST(AgvPlant, follows_a_command_with_its_motors_lag) {
  AgvPlant plant(exact());
  drive(plant, 8, 8);
  plant.advance(0.1);
  EXPECT_NEAR(plant.motor(0).speed_rad_s, 120 * (1 - std::exp(-1.0)), 0.1);
}

TEST(AgvPlant, cannot_brake_harder_than_friction_holds) {
  AgvPlantConfig config = exact();
  config.friction = 0.1;
  config.motor_lag_s = 0;
  AgvPlant plant(config);
  drive(plant, 10, 10);
  plant.advance(4);
  const double before = plant.velocity().linear.x();
  drive(plant, 0, 0);
  plant.advance(0.1);
  EXPECT_NEAR(before - plant.velocity().linear.x(), 0.1 * (0.1 + 0.015) * 9.81, 2e-3);
  EXPECT_EQ(plant.slip(0), -1);
}

TEST(AgvPlant, drifts_from_what_its_wheels_say_by_their_errors) {
  AgvPlantConfig config = exact();
  config.radius_error = {0.01, -0.01};
  AgvPlant plant(config);
  drive(plant, 8, 8);
  plant.advance(5);
  EXPECT_NEAR(plant.velocity().angular.z(), -0.8 * 0.02 / 0.5, 1e-3);
}

TEST(AgvPlant, stands_with_jammed_wheels) {
  AgvPlant plant(exact());
  plant.jam(0, true);
  drive(plant, 8, 8);
  plant.advance(1);
  EXPECT_EQ(plant.motor(0).speed_rad_s, 0);
  EXPECT_GT(plant.motor(1).position_rad, 0);
}

}  // namespace
}  // namespace gannet::world
