#include "src/servo/pose_regulation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "platform/base/random.hpp"
#include "tests/support/count_heap.hpp"

namespace gannet::servo {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kStep = 0.005;
constexpr Duration kCycle = from_seconds(kStep);

// Cameras look forward from 0.2 m before and 0.05 m below the body's origin.
Transform<Body, Hand> body_from_hand() {
  Matrix3d r;
  r << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {Quaterniond(r), {0.2, 0, -0.05}};
}
Transform<Hand, LeftCamera> hand_from_left() { return {Quaterniond::Identity(), {-0.06, 0, 0}}; }
Transform<LeftCamera, Body> left_from_body() {
  return (body_from_hand() * hand_from_left()).inverse();
}

ServoParams no_limits() {
  ServoParams p;
  p.max_speed_m_s = p.max_rate_rad_s = 1e3;
  p.max_acceleration_m_s2 = p.max_acceleration_rad_s2 = 1e6;
  return p;
}

// The truth in the world, and what a perfect filter says of it.
struct Scene {
  Transform<World, Body> body;
  Transform<World, Target> target;
  TargetVelocity target_in_world;
  Twist<Body> own;

  PredictedPose seen() const {
    const Transform<LeftCamera, World> left_from_world = left_from_body() * body.inverse();
    const Twist<LeftCamera> camera = joined_twist(left_from_body(), own);
    PredictedPose p;
    p.valid = true;
    p.left_from_target = left_from_world * target;
    p.target.linear = left_from_world.rotation * target_in_world.linear;
    p.target.angular = left_from_world.rotation * target_in_world.angular;
    p.relative.linear =
        p.target.linear - camera.linear - camera.angular.cross(p.left_from_target.translation);
    p.relative.angular = p.target.angular - camera.angular;
    return p;
  }
  Transform<Hand, Target> in_hand() const { return (body * body_from_hand()).inverse() * target; }
  // The body moves exactly as told.
  void move(const Twist<Body>& twist) {
    own = twist;
    body.translation += body.rotation * twist.linear * kStep;
    body.rotation = body.rotation * quaternion_from_rotation_vector(twist.angular * kStep);
    target.translation += target_in_world.linear * kStep;
    target.rotation =
        quaternion_from_rotation_vector(target_in_world.angular * kStep) * target.rotation;
  }
};

// The target where the goal wants it, seen from a body at the world's origin.
Scene at_goal(const Goal& goal) {
  Scene scene;
  scene.target = scene.body * body_from_hand() * goal.hand_from_target;
  return scene;
}

PoseRegulation law(const ServoParams& params) {
  return PoseRegulation(params, hand_from_left(), body_from_hand());
}

Scene displaced(Random& random, double metres, double radians) {
  Scene scene = at_goal(Goal());
  const auto vector = [&] {
    return Vector3d(2 * random.uniform() - 1, 2 * random.uniform() - 1, 2 * random.uniform() - 1);
  };
  scene.body.translation += metres * vector();
  scene.body.rotation = quaternion_from_rotation_vector(radians * vector());
  return scene;
}

TEST(PoseRegulation, wishes_nothing_at_the_goal) {
  auto sut = law(ServoParams());
  const Scene scene = at_goal(Goal());
  const MotionWish wish = sut.update(scene.seen(), Goal(), Permit::kFull, kCycle);
  EXPECT_LT(wish.velocity.linear.norm(), 1e-12);
  EXPECT_LT(wish.velocity.angular.norm(), 1e-12);
  EXPECT_TRUE(wish.measured_valid);
}

TEST(PoseRegulation, moves_towards_a_target_that_is_too_far_left_high_or_turned) {
  for (const Vector3d& shift :
       {Vector3d(0.1, 0, 0), Vector3d(0, 0.1, 0), Vector3d(0, 0, 0.1), Vector3d(-0.1, -0.1, 0)}) {
    auto sut = law(no_limits());
    Scene scene = at_goal(Goal());
    scene.target.translation += shift;
    const MotionWish wish = sut.update(scene.seen(), Goal(), Permit::kFull, kCycle);
    EXPECT_LT((wish.velocity.linear - 1.2 * shift).norm(), 1e-9);
    EXPECT_LT(wish.velocity.angular.norm(), 1e-9);
  }
  // A target turned to the left wants the body to turn left and to go round it to the right.
  auto sut = law(no_limits());
  Scene scene = at_goal(Goal());
  scene.target.rotation = quaternion_from_rpy(0, 0, 0.3) * scene.target.rotation;
  const MotionWish wish = sut.update(scene.seen(), Goal(), Permit::kFull, kCycle);
  EXPECT_NEAR(wish.velocity.angular.z(), 1.2 * 0.3, 1e-9);
  EXPECT_NEAR(wish.velocity.linear.y(), -1.2 * 0.3 * 0.7, 1e-9);  // 0.5 m + 0.2 m lever
}

// ṗ = −k·e in Σ_H while the body turns: the position error goes straight to zero.
TEST(PoseRegulation, brings_all_six_errors_to_zero_and_the_position_on_a_straight_line) {
  Random random(1);
  ServoParams params = no_limits();
  params.control_roll = params.control_pitch = true;
  for (int trial = 0; trial < 30; ++trial) {
    auto sut = law(params);
    Scene scene = displaced(random, 0.3, 0.4);
    const Vector3d start = scene.in_hand().translation - Vector3d(0, 0, 0.5);
    for (int i = 0; i < 1200; ++i) {
      scene.move(sut.update(scene.seen(), Goal(), Permit::kFull, kCycle).velocity);
      const Vector3d e = scene.in_hand().translation - Vector3d(0, 0, 0.5);
      const Vector3d expected = std::exp(-1.2 * kStep * (i + 1)) * start;
      ASSERT_LT((e - expected).norm(), 0.02 * start.norm());
    }
    const auto end = scene.in_hand();
    EXPECT_LT((end.translation - Vector3d(0, 0, 0.5)).norm(), 0.002);
    EXPECT_LT(rotation_vector_from_quaternion(end.rotation).norm(), 0.002);
  }
}

TEST(PoseRegulation, asks_only_for_the_axes_it_controls) {
  Random random(2);
  auto sut = law(ServoParams());
  for (int i = 0; i < 200; ++i) {
    const Scene scene = displaced(random, 0.3, 0.4);
    const MotionWish wish = sut.update(scene.seen(), Goal(), Permit::kFull, kCycle);
    EXPECT_EQ(wish.velocity.angular.x(), 0);
    EXPECT_EQ(wish.velocity.angular.y(), 0);
  }
}

TEST(PoseRegulation, is_not_turned_by_a_target_that_is_only_tilted) {
  auto sut = law(ServoParams());
  Scene scene = at_goal(Goal());
  scene.target.rotation = quaternion_from_rpy(0, 0.6, 0) * scene.target.rotation;
  const MotionWish wish = sut.update(scene.seen(), Goal(), Permit::kFull, kCycle);
  EXPECT_LT(std::abs(wish.velocity.angular.z()), 1e-9);
}

TEST(PoseRegulation, keeps_its_limits_of_speed_and_acceleration) {
  Random random(3);
  const ServoParams p;
  for (int trial = 0; trial < 20; ++trial) {
    auto sut = law(p);
    Scene scene = displaced(random, 1.5, 0.8);
    Vector3d last_linear = Vector3d::Zero(), last_angular = Vector3d::Zero();
    for (int i = 0; i < 2000; ++i) {
      const Twist<Body> v = sut.update(scene.seen(), Goal(), Permit::kFull, kCycle).velocity;
      // What the hand does beyond going round the target while it turns.
      const auto hand = joined_twist(body_from_hand().inverse(), v);
      const Vector3d linear = hand.linear + hand.angular.cross(scene.in_hand().translation);
      ASSERT_LE((linear - last_linear).norm(), p.max_acceleration_m_s2 * kStep + 1e-9);
      ASSERT_LE((v.angular - last_angular).norm(), p.max_acceleration_rad_s2 * kStep + 1e-9);
      ASSERT_LE(linear.norm(), p.max_speed_m_s + 1e-9);
      ASSERT_LE(v.angular.norm(), p.max_rate_rad_s + 1e-9);
      last_linear = linear;
      last_angular = v.angular;
      scene.move(v);
    }
    EXPECT_LT(sut.error().position_m.norm(), 0.02);
  }
}

TEST(PoseRegulation, does_not_overshoot_a_far_goal) {
  auto sut = law(ServoParams());
  Scene scene = at_goal(Goal());
  scene.target.translation.x() += 2;
  double least = 2;
  for (int i = 0; i < 3000; ++i) {
    scene.move(sut.update(scene.seen(), Goal(), Permit::kFull, kCycle).velocity);
    least = std::min(least, scene.in_hand().translation.z() - 0.5);
  }
  EXPECT_GT(least, -0.005);
  EXPECT_LT(sut.error().position_m.norm(), 0.005);
}

// Behind a target of constant velocity u a proportional law lags by u / k; with feed-forward not.
TEST(PoseRegulation, lags_behind_a_moving_target_only_without_feed_forward) {
  for (const bool feed_forward : {false, true}) {
    ServoParams params = no_limits();
    params.feed_forward = feed_forward;
    auto sut = law(params);
    Scene scene = at_goal(Goal());
    scene.target_in_world.linear = {0.02, 0.03, -0.01};
    for (int i = 0; i < 2000; ++i) {
      scene.move(sut.update(scene.seen(), Goal(), Permit::kFull, kCycle).velocity);
    }
    const double lag = scene.target_in_world.linear.norm() / 1.2;
    EXPECT_NEAR(sut.error().position_m.norm(), feed_forward ? 0 : lag, 0.01 * lag);
  }
}

TEST(PoseRegulation, follows_a_turning_target) {
  auto sut = law(no_limits());
  Scene scene = at_goal(Goal());
  scene.target_in_world.angular.z() = 0.2;
  for (int i = 0; i < 2000; ++i) {
    scene.move(sut.update(scene.seen(), Goal(), Permit::kFull, kCycle).velocity);
  }
  EXPECT_LT(sut.error().position_m.norm(), 0.001);
  EXPECT_LT(sut.error().rotation_rad.norm(), 0.001);
}

TEST(PoseRegulation, measures_the_own_velocity) {
  Random random(5);
  auto sut = law(ServoParams());
  for (int i = 0; i < 100; ++i) {
    Scene scene = displaced(random, 0.3, 0.5);
    scene.target_in_world = {{0.1, -0.2, 0.05}, {0.1, 0.2, 0.3}};
    scene.own = {{random.uniform(), -0.2, 0.1}, {0.3, random.uniform(), -0.4}};
    const MotionWish wish = sut.update(scene.seen(), Goal(), Permit::kFull, kCycle);
    EXPECT_LT((wish.measured.linear - scene.own.linear).norm(), 1e-9);
    EXPECT_LT((wish.measured.angular - scene.own.angular).norm(), 1e-9);
  }
}

TEST(PoseRegulation, holds_still_without_full_permit_and_without_a_prediction) {
  Random random(6);
  auto sut = law(no_limits());
  const Scene scene = displaced(random, 0.3, 0.3);
  EXPECT_GT(sut.update(scene.seen(), Goal(), Permit::kFull, kCycle).velocity.linear.norm(), 0.01);
  MotionWish wish = sut.update(scene.seen(), Goal(), Permit::kHoldOnly, kCycle);
  EXPECT_EQ(wish.velocity.linear.norm() + wish.velocity.angular.norm(), 0);
  EXPECT_TRUE(wish.measured_valid);
  wish = sut.update(scene.seen(), Goal(), Permit::kNone, kCycle);
  EXPECT_EQ(wish.velocity.linear.norm() + wish.velocity.angular.norm(), 0);
  EXPECT_FALSE(wish.measured_valid);
  wish = sut.update(PredictedPose(), Goal(), Permit::kFull, kCycle);
  EXPECT_EQ(wish.velocity.linear.norm() + wish.velocity.angular.norm(), 0);
  EXPECT_FALSE(wish.measured_valid);
}

TEST(PoseRegulation, takes_new_parameters_at_the_next_update) {
  auto sut = law(no_limits());
  Scene scene = at_goal(Goal());
  scene.target.translation.x() += 0.1;
  EXPECT_NEAR(sut.update(scene.seen(), Goal(), Permit::kFull, kCycle).velocity.linear.x(), 0.12,
              1e-9);
  ServoParams params = no_limits();
  params.position_gain = 2;
  sut.set(params);
  EXPECT_NEAR(sut.update(scene.seen(), Goal(), Permit::kFull, kCycle).velocity.linear.x(), 0.2,
              1e-9);
}

TEST(PoseRegulation, takes_nothing_from_the_heap) {
  if (!test::kCountsHeap) GTEST_SKIP() << "the sanitizer has its own heap";
  Random random(8);
  auto sut = law(ServoParams());
  const PredictedPose seen = displaced(random, 0.3, 0.3).seen();
  const auto before = test::heap_calls;
  for (int i = 0; i < 100; ++i) {
    sut.update(seen, goal_of(ServoParams()), static_cast<Permit>(i % 3), kCycle);
  }
  EXPECT_EQ(test::heap_calls, before);
}

TEST(ServoLaw, needs_to_know_how_the_cameras_sit_in_the_vehicle) {
  StereoRig rig;
  EXPECT_FALSE(create_servo_law(ServoConfig(), rig));
  rig.body_from_hand = body_from_hand();
  EXPECT_TRUE(create_servo_law(ServoConfig(), rig));
  ServoConfig config;
  config.law = "telepathy";
  const auto sut = create_servo_law(config, rig);
  ASSERT_FALSE(sut);
  EXPECT_NE(sut.error().text.find("telepathy"), std::string::npos);
}

TEST(Goal, is_half_a_metre_ahead_and_level_by_default) {
  const Goal sut = goal_of(ServoParams());
  EXPECT_EQ(sut.hand_from_target.translation, Vector3d(0, 0, 0.5));
  EXPECT_LT(rotation_vector_from_quaternion(sut.hand_from_target.rotation).norm(), 1e-12);
}

}  // namespace
}  // namespace gannet::servo
