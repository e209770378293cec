// PoseRegulation: position-based visual servoing (P001 §3; S. Hutchinson, G. Hager, P. Corke, "A
// tutorial on visual servo control", IEEE Trans. Robotics and Automation 12(5), 1996, §III). The
// pose error in Σ_H becomes a velocity of Σ_H, that one of the body:
//
//   ω = w + k_θ·θ            θ: rotation from the goal's to the seen orientation
//   v = u + k_p·e − ω × p    e = p − p_goal; u, w: the target's own motion; p: where it is
//
// With v the target's position in Σ_H obeys ṗ = −k_p·e, also while the vehicle turns. The approach
// is limited in speed, in acceleration, and by what can be braked in the distance left.
// Servo thread; RT safe.
#pragma once

#include <array>

#include "src/servo/servo_law.hpp"

namespace gannet::servo {

class PoseRegulation final : public ServoLaw {
 public:
  PoseRegulation(const ServoParams& params, const Transform<Hand, LeftCamera>& hand_from_left,
                 const Transform<Body, Hand>& body_from_hand)
      : params_(params), hand_from_left_(hand_from_left), body_from_hand_(body_from_hand) {}

  MotionWish update(const PredictedPose& target, const Goal& goal, Permit permit,
                    Duration dt) override;
  ServoError error() const override { return error_; }
  void set(const ServoParams& params) override { params_ = params; }

 private:
  Eigen::Vector3d rotation_error(const Eigen::Quaterniond& seen_from_goal) const;
  void advance_approach(double seconds);
  Twist<Body> wished(const PredictedPose& target, const Eigen::Vector3d& position) const;
  Twist<Body> measured(const PredictedPose& target, const Eigen::Vector3d& position) const;
  Twist<Body> on_axes(const Twist<Body>& twist) const;

  ServoParams params_;
  Transform<Hand, LeftCamera> hand_from_left_;
  Transform<Body, Hand> body_from_hand_;
  ServoError error_;
  Twist<Hand> approach_;  // k·e and k·θ, limited
};

}  // namespace gannet::servo
