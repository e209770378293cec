#include "src/world/arm_plant.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "src/world/thruster.hpp"

namespace gannet::world {
namespace {

double turn_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return rotation_vector_from_quaternion(a.conjugate() * b).norm();
}

TEST(ArmPlant, stands_at_the_reference_with_its_joints_at_rest) {
  const ArmPlant plant{ArmPlantConfig{}};
  EXPECT_LT(plant.pose().translation.norm(), 1e-12);
  EXPECT_LT(turn_between(plant.pose().rotation, Eigen::Quaterniond::Identity()), 1e-9);
  EXPECT_NEAR(plant.motor(3).position_rad, 50 * std::acos(0.0), 1e-9);  // the elbow, 90°
}

TEST(ArmPlant, is_put_where_it_is_wanted) {
  ArmPlant plant{ArmPlantConfig{}};
  const Transform<World, Body> wanted{quaternion_from_rpy(0.1, -0.1, 0.15), {0.05, -0.12, 0.1}};
  plant.set_pose(wanted);
  EXPECT_LT((plant.pose().translation - wanted.translation).norm(), 1e-9);
  EXPECT_LT(turn_between(plant.pose().rotation, wanted.rotation), 1e-9);
  plant.advance(0.1);
  EXPECT_LT((plant.pose().translation - wanted.translation).norm(), 1e-9);
}

TEST(ArmPlant, follows_its_drives_with_the_lag) {
  ArmPlant plant{ArmPlantConfig{}};
  std::vector<double> throttles(7, 0.0);
  throttles[0] = throttle_at_speed(10);  // 0.2 rad/s of the joint
  plant.command(throttles);
  plant.advance(0.03);
  EXPECT_NEAR(plant.motor(0).speed_rad_s, 10 * (1 - std::exp(-1)), 1e-3);
  plant.advance(0.3);
  EXPECT_NEAR(plant.motor(0).speed_rad_s, 10, 1e-3);
  EXPECT_NEAR(plant.velocity().angular.norm(), 0.2, 1e-4);
  const double before = plant.motor(0).position_rad;
  plant.advance(0.1);
  EXPECT_NEAR(plant.motor(0).position_rad - before, 1, 1e-3);
  plant.jam(0, true);
  plant.advance(0.1);
  EXPECT_EQ(plant.motor(0).speed_rad_s, 0);
}

TEST(ArmPlant, velocity_is_the_derivative_of_the_pose) {
  ArmPlant plant{ArmPlantConfig{}};
  std::vector<double> throttles;
  for (int i = 0; i < 7; ++i) throttles.push_back(throttle_at_speed(4 - 2 * i));
  plant.command(throttles);
  plant.advance(0.5);
  const auto before = plant.pose();
  const auto twist = plant.velocity();
  plant.advance(0.001);
  const Eigen::Vector3d moved =
      before.rotation.conjugate() * (plant.pose().translation - before.translation) / 0.001;
  EXPECT_LT((moved - twist.linear).norm(), 1e-3);
}

TEST(ArmPlant, stops_at_a_limit_of_angle) {
  ArmPlant plant{ArmPlantConfig{}};
  std::vector<double> throttles(7, 0.0);
  throttles[1] = throttle_at_speed(50);  // S2 from 45° towards its 90°
  plant.command(throttles);
  plant.advance(3);
  EXPECT_NEAR(plant.angles()[1], std::acos(0.0), 1e-9);
  EXPECT_EQ(plant.motor(1).speed_rad_s, 0);
}

}  // namespace
}  // namespace gannet::world
