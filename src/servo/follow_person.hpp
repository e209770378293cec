// FollowPerson: keeps a ground vehicle behind somebody at the goal's distance and bearing (P004
// §4.2 keeps 4 m). On the floor, with d the person's distance from the hand, β the bearing from the
// body's upward axis, u the person's own velocity along and n across the line of sight:
//
//   v = (u + approach(d − d_goal)) · s,   s = 1 at the goal and beyond, falling to 0 at near_m
//   ω = k_θ·(β − β_goal) + (n + v·sin β) / range
//
// approach is k_p·e within max_speed_m_s and what can be braked in the distance left; nearer than
// the goal v never exceeds u, so it never closes in. How fast v and ω may change is the vehicle's.
// Servo thread; RT safe.
#pragma once

#include "src/servo/servo_law.hpp"

namespace gannet::servo {

class FollowPerson final : public ServoLaw {
 public:
  FollowPerson(const ServoParams& params, const Transform<Hand, LeftCamera>& hand_from_left,
               const Transform<Body, Hand>& body_from_hand)
      : params_(params), hand_from_left_(hand_from_left), body_from_hand_(body_from_hand) {}

  MotionWish update(const PredictedPose& target, const Goal& goal, Permit permit,
                    Duration dt) override;
  ServoError error() const override { return error_; }
  void set(const ServoParams& params) override { params_ = params; }

 private:
  double speed_ahead(double distance_m, double goal_m, double leaves_m_s) const;

  ServoParams params_;
  Transform<Hand, LeftCamera> hand_from_left_;
  Transform<Body, Hand> body_from_hand_;
  ServoError error_;
};

}  // namespace gannet::servo
