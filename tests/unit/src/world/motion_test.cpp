#include "src/world/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace gannet::world {
namespace {

MotionConfig of_kind(const char* kind) {
  MotionConfig config;
  config.kind = kind;
  return config;
}

TEST(Motion, still_stays) {
  const Motion sut(of_kind("still"), 1);
  EXPECT_EQ(sut.at(0).translation.norm(), 0);
  EXPECT_EQ(sut.at(17).translation.norm(), 0);
  EXPECT_EQ(sut.at(17).rotation.vec().norm(), 0);
}

TEST(Motion, p001_is_the_published_path) {
  MotionConfig config = of_kind("p001");
  config.amplitude_mm = {1, 1, 1};  // the paper's win
  const Motion sut(config, 1);
  EXPECT_NEAR(sut.at(5).translation.x(), 0.1, 1e-12);  // a quarter of 20 s
  EXPECT_NEAR(sut.at(15).translation.x(), -0.1, 1e-12);
  EXPECT_NEAR(sut.at(0).translation.y(), 0.1, 1e-12);
  EXPECT_NEAR(sut.at(15).translation.z(), 0.1, 1e-12);  // a quarter of 60 s
  EXPECT_NEAR((sut.at(60).translation - sut.at(0).translation).norm(), 0, 1e-12);
}

TEST(Motion, sine_turns_too) {
  MotionConfig config = of_kind("sine");
  config.turn_deg = {0, 0, 10};
  config.period_s = {4, 4, 4};
  const Motion sut(config, 1);
  const auto turn = rotation_vector_from_quaternion(sut.at(1).rotation);
  EXPECT_NEAR(turn.z(), 10 * 3.14159265358979 / 180, 1e-9);
  EXPECT_NEAR(turn.x(), 0, 1e-12);
}

TEST(Motion, random_is_bounded_smooth_and_repeats) {
  MotionConfig config = of_kind("random");
  config.amplitude_mm = {50, 80, 20};
  config.bandwidth_hz = 0.5;
  const Motion a(config, 7), b(config, 7), other(config, 8);
  double most = 0;
  for (double t = 0; t < 60; t += 0.01) {
    const Eigen::Vector3d p = a.at(t).translation;
    most = std::max(most, std::abs(p.y()));
    EXPECT_LE(std::abs(p.x()), 0.05);
    EXPECT_LE(std::abs(p.y()), 0.08);
    EXPECT_LT((a.at(t + 0.01).translation - p).norm() / 0.01, 2 * 3.1416 * 0.5 * 0.097);
    EXPECT_EQ(p, b.at(t).translation);
  }
  EXPECT_GT(most, 0.02);
  EXPECT_NE(a.at(3).translation, other.at(3).translation);
}

TEST(Motion, waypoints_are_met_and_joined) {
  MotionConfig config = of_kind("waypoints");
  config.waypoints = {{1, {0, 0, 0}}, {3, {100, 0, 0}}, {4, {100, 50, 0}}};
  config.start_s = 2;
  const Motion sut(config, 1);
  EXPECT_EQ(sut.at(0).translation.norm(), 0);
  EXPECT_EQ(sut.at(3).translation.norm(), 0);
  EXPECT_NEAR(sut.at(4).translation.x(), 0.05, 1e-12);
  EXPECT_NEAR(sut.at(5).translation.x(), 0.1, 1e-12);
  EXPECT_NEAR(sut.at(100).translation.y(), 0.05, 1e-12);
}

}  // namespace
}  // namespace gannet::world
