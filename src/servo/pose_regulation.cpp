#include "src/servo/pose_regulation.hpp"

#include <algorithm>
#include <cmath>

namespace gannet::servo {
namespace {

using Eigen::Vector3d;

// k·error, no faster than max_speed and than what can be braked within the error.
Vector3d approach(const Vector3d& error, double gain, double max_speed, double max_acceleration) {
  const double distance = error.norm();
  if (distance < 1e-12) return Vector3d::Zero();
  const double speed =
      std::min({gain * distance, max_speed, std::sqrt(2 * max_acceleration * distance)});
  return speed / distance * error;
}

// From `from` towards `to`, no farther than step.
Vector3d slewed(const Vector3d& from, const Vector3d& to, double step) {
  const Vector3d change = to - from;
  const double size = change.norm();
  return size <= step ? to : Vector3d(from + step / size * change);
}

}  // namespace

// One axis alone is steered by the twist part of the rotation about it, for an ROV that only turns
// about its upward axis cannot act on the rest, which must not leak in.
Vector3d PoseRegulation::rotation_error(const Eigen::Quaterniond& seen_from_goal) const {
  const std::array<bool, 3> axes = {params_.control_roll, params_.control_pitch,
                                    params_.control_yaw};
  if (axes[0] + axes[1] + axes[2] != 1) return rotation_vector_from_quaternion(seen_from_goal);
  const int i = axes[0] ? 0 : axes[1] ? 1 : 2;
  const Vector3d axis = body_from_hand_.rotation.conjugate() * Vector3d::Unit(i);
  const Eigen::Quaterniond q = canonical(seen_from_goal);
  return 2 * std::atan2(axis.dot(q.vec()), q.w()) * axis;
}

Twist<Body> PoseRegulation::on_axes(const Twist<Body>& twist) const {
  const ServoParams& p = params_;
  return {{p.control_x ? twist.linear.x() : 0, p.control_y ? twist.linear.y() : 0,
           p.control_z ? twist.linear.z() : 0},
          {p.control_roll ? twist.angular.x() : 0, p.control_pitch ? twist.angular.y() : 0,
           p.control_yaw ? twist.angular.z() : 0}};
}

// Only the approach is slewed: the target's own motion is in wish and measurement alike, and what
// is added to both must be the same in both.
void PoseRegulation::advance_approach(double seconds) {
  const ServoParams& p = params_;
  approach_.linear =
      slewed(approach_.linear,
             approach(error_.position_m, p.position_gain, p.max_speed_m_s, p.max_acceleration_m_s2),
             p.max_acceleration_m_s2 * seconds);
  approach_.angular = slewed(
      approach_.angular,
      approach(error_.rotation_rad, p.rotation_gain, p.max_rate_rad_s, p.max_acceleration_rad_s2),
      p.max_acceleration_rad_s2 * seconds);
}

Twist<Body> PoseRegulation::wished(const PredictedPose& target, const Vector3d& position) const {
  const Eigen::Quaterniond& turn = hand_from_left_.rotation;
  const double follow = params_.feed_forward ? 1 : 0;
  // Only what the body turns about counts, here and in ω × p.
  Twist<Body> spin;
  spin.angular =
      body_from_hand_.rotation * (approach_.angular + follow * (turn * target.target.angular));
  Twist<Hand> hand;
  hand.angular = body_from_hand_.rotation.conjugate() * on_axes(spin).angular;
  hand.linear =
      approach_.linear + follow * (turn * target.target.linear) - hand.angular.cross(position);
  return on_axes(joined_twist(body_from_hand_, hand));
}

// Own velocity = the target's own minus what the camera sees of it: ṗ = u − v − ω × p. Without
// feed-forward the target is taken to rest here too, for wish and measurement must mean the same:
// their difference is then what the camera sees, and what the model of the own motion does not
// know, a current or a push, leaves no lasting error.
Twist<Body> PoseRegulation::measured(const PredictedPose& target, const Vector3d& position) const {
  const Eigen::Quaterniond& turn = hand_from_left_.rotation;
  const double follow = params_.feed_forward ? 1 : 0;
  Twist<Hand> hand;
  hand.angular = turn * (follow * target.target.angular - target.relative.angular);
  // The left camera's origin is not the hand's: the relative velocity of the target's origin is
  // that in the rigidly joined hand frame, up to the rotation.
  hand.linear = turn * (follow * target.target.linear - target.relative.linear) -
                hand.angular.cross(position);
  return joined_twist(body_from_hand_, hand);
}

MotionWish PoseRegulation::update(const PredictedPose& target, const Goal& goal, Permit permit,
                                  Duration dt) {
  MotionWish wish;
  const Transform<Hand, Target> seen = hand_from_left_ * target.left_from_target;
  if (target.valid) {
    error_.position_m = seen.translation - goal.hand_from_target.translation;
    error_.rotation_rad =
        rotation_error(seen.rotation * goal.hand_from_target.rotation.conjugate());
    wish.measured = measured(target, seen.translation);
    wish.measured_valid = permit != Permit::kNone;
  }
  // Stopping is not slewed: a hold or no permit is meant now.
  if (permit == Permit::kFull && target.valid) {
    advance_approach(to_seconds(dt));
    wish.velocity = wished(target, seen.translation);
  } else {
    approach_ = {};
  }
  return wish;
}

}  // namespace gannet::servo
