#include "src/servo/follow_person.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gannet::servo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Nearer than this a bearing means nothing.
constexpr double kLeastRange_m = 0.05;

double bearing_of(const Vector2d& place) { return std::atan2(place.y(), place.x()); }

double wrapped(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

}  // namespace

double FollowPerson::speed_ahead(double distance_m, double goal_m, double leaves_m_s) const {
  const ServoParams& p = params_;
  const double error = distance_m - goal_m;
  const double size = std::min({p.position_gain * std::abs(error), p.max_speed_m_s,
                                std::sqrt(2 * p.max_acceleration_m_s2 * std::abs(error))});
  const double with = p.feed_forward ? leaves_m_s : 0;
  if (error >= 0) return distance_m > p.near_m ? with + size : 0;
  const double softly =
      goal_m > p.near_m ? std::clamp((distance_m - p.near_m) / (goal_m - p.near_m), 0.0, 1.0) : 0;
  const double speed = with - size;
  return speed > 0 ? softly * speed : speed;
}

MotionWish FollowPerson::update(const PredictedPose& target, const Goal& goal, Permit permit,
                                Duration) {
  MotionWish wish;
  if (!target.valid) return wish;
  const Transform<Hand, Target> seen = hand_from_left_ * target.left_from_target;
  error_.position_m = seen.translation - goal.hand_from_target.translation;

  // On the floor: the body's x and y.
  const Vector2d hand = body_from_hand_.translation.head<2>();
  const auto on_floor = [&](const Vector3d& in_hand) {
    return Vector2d((body_from_hand_.rotation * in_hand).head<2>());
  };
  const Vector2d from_hand = on_floor(seen.translation);
  const Vector2d goal_from_hand = on_floor(goal.hand_from_target.translation);
  const Vector2d place = hand + from_hand;
  const double range = std::max(place.norm(), kLeastRange_m);
  const double bearing = bearing_of(place);
  const double turn = wrapped(bearing - bearing_of(hand + goal_from_hand));
  // About the body's upward axis, as the hand has it.
  error_.rotation_rad = body_from_hand_.rotation.conjugate() * Vector3d(0, 0, turn);
  if (permit != Permit::kFull) return wish;

  const Vector2d own = on_floor(hand_from_left_.rotation * target.target.linear);
  const Vector2d along(std::cos(bearing), std::sin(bearing));
  const double leaves = own.dot(along);
  const double across = own.y() * along.x() - own.x() * along.y();
  const double speed = speed_ahead(from_hand.norm(), goal_from_hand.norm(), leaves);
  const double follow = params_.feed_forward ? across : 0;
  const double rate = params_.rotation_gain * turn + (follow + speed * along.y()) / range;
  wish.velocity.linear.x() = speed;
  wish.velocity.angular.z() = std::clamp(rate, -params_.max_rate_rad_s, params_.max_rate_rad_s);
  return wish;
}

}  // namespace gannet::servo
