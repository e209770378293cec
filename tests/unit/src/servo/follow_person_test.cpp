#include "src/servo/follow_person.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace gannet::servo {
namespace {

constexpr Duration kCycle = from_seconds(0.005);

Transform<Body, Hand> mounted() {
  Eigen::Matrix3d forward;
  forward << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {Eigen::Quaterniond(forward), {0.2, 0, 0.9}};
}

ServoParams params() {
  ServoParams p;
  p.position_gain = 1;
  p.max_speed_m_s = 0.5;
  p.goal_z_m = 4;
  p.near_m = 2;
  return p;
}

// Seen from the hand: right and ahead; its own motion there.
PredictedPose person(double right_m, double ahead_m, double goes_right = 0, double goes_away = 0) {
  PredictedPose seen;
  seen.valid = true;
  seen.left_from_target.translation = {right_m, 0.1, ahead_m};
  seen.target.linear = {goes_right, 0, goes_away};
  return seen;
}

MotionWish wish(const PredictedPose& seen, const ServoParams& p = params(),
                Permit permit = Permit::kFull) {
  FollowPerson law(p, {}, mounted());
  return law.update(seen, goal_of(p), permit, kCycle);
}

double speed(const PredictedPose& seen) { return wish(seen).velocity.linear.x(); }
double turn(const PredictedPose& seen) { return wish(seen).velocity.angular.z(); }

TEST(FollowPerson, rests_at_the_wanted_distance) {
  EXPECT_NEAR(speed(person(0, 4)), 0, 1e-12);
  EXPECT_NEAR(turn(person(0, 4)), 0, 1e-12);
}

TEST(FollowPerson, comes_nearer_by_its_gain_and_no_faster_than_allowed) {
  EXPECT_NEAR(speed(person(0, 4.2)), 0.2, 1e-9);
  EXPECT_NEAR(speed(person(0, 6)), 0.5, 1e-9);
}

TEST(FollowPerson, goes_with_who_walks_away) {
  EXPECT_NEAR(speed(person(0, 4, 0, 0.9)), 0.9, 1e-9);
  EXPECT_NEAR(speed(person(0, 4.1, 0, 0.9)), 1.0, 1e-9);
}

TEST(FollowPerson, never_closes_in_on_who_is_nearer_than_wanted) {
  for (double ahead = 0.1; ahead < 4; ahead += 0.1) {
    for (double away = -1; away <= 1; away += 0.25) {
      EXPECT_LE(speed(person(0, ahead, 0, away)), std::max(0.0, away)) << ahead << " " << away;
    }
    EXPECT_LE(speed(person(0, ahead)), 0);
  }
  EXPECT_LE(speed(person(0, 1.9, 0, 3)), 0);
}

TEST(FollowPerson, turns_to_the_side_where_the_person_is) {
  EXPECT_LT(turn(person(0.5, 4)), 0);
  EXPECT_GT(turn(person(-0.5, 4)), 0);
  EXPECT_GT(turn(person(0, 4, -0.5, 0)), 0);
}

// Integrated: who walks in a circle is kept at the distance and in the middle.
TEST(FollowPerson, keeps_distance_and_bearing_behind_a_curve) {
  ServoParams p = params();
  p.max_rate_rad_s = 2;
  FollowPerson law(p, {}, mounted());
  Transform<World, Body> body;
  double worst_m = 0, worst_rad = 0;
  for (int i = 0; i < 8000; ++i) {
    const double t = i * 0.005, r = 5, w = 0.12;
    const Eigen::Vector3d at(4.2 + r * std::sin(w * t), r - r * std::cos(w * t), 0.9);
    const Eigen::Vector3d goes(r * w * std::cos(w * t), r * w * std::sin(w * t), 0);
    const Transform<World, Hand> hand = body * mounted();
    PredictedPose seen;
    seen.valid = true;
    seen.left_from_target.translation = hand.inverse()(at);
    seen.target.linear = hand.rotation.conjugate() * goes;
    const MotionWish m = law.update(seen, goal_of(p), Permit::kFull, kCycle);
    body = body * Transform<Body, Body>{quaternion_from_rpy(0, 0, m.velocity.angular.z() * 0.005),
                                        {m.velocity.linear.x() * 0.005, 0, 0}};
    if (t < 10) continue;
    worst_m = std::max(worst_m, std::abs(seen.left_from_target.translation.norm() - 4));
    worst_rad = std::max(worst_rad, std::abs(law.error().rotation_rad.y()));
  }
  EXPECT_LT(worst_m, 0.02);
  EXPECT_LT(worst_rad, 0.01);
}

TEST(FollowPerson, wishes_to_stand_without_a_person_or_a_permit) {
  PredictedPose nobody = person(0, 6);
  nobody.valid = false;
  EXPECT_EQ(speed(nobody), 0);
  EXPECT_EQ(turn(nobody), 0);
  EXPECT_EQ(wish(person(0, 6), params(), Permit::kHoldOnly).velocity.linear.x(), 0);
}

TEST(FollowPerson, is_a_law_by_its_name) {
  ServoConfig config;
  config.law = "follow_person";
  StereoRig rig;
  rig.body_from_hand = mounted();
  EXPECT_TRUE(create_servo_law(config, rig));
}

}  // namespace
}  // namespace gannet::servo
