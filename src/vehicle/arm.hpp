// Arm: a serial arm with the cameras on its hand. Its body is the hand: Σ_B sits on the last link
// (ArmConfig), body_from_hand of the rig says how the cameras sit there, and the wish is a twist
// of the hand. joint_rates makes speeds of it at the angles that the drives report; setpoint 1 is
// drive.motor.full_speed_rad_s of the shaft that the drive speaks of. The drives close the loops
// of speed, vision that of position, so there is no integral here.
// Each joint keeps its speed, its acceleration, and what it can brake with half of that before its
// limit of angle, lag and delay being unknown. Angles that are too old, or missing, move nothing.
// Servo thread; RT safe after creation.
#pragma once

#include <vector>

#include "src/vehicle/arm_chain.hpp"
#include "src/vehicle/arm_rates.hpp"
#include "src/vehicle/vehicle.hpp"

namespace gannet::vehicle {

class Arm final : public Vehicle {
 public:
  static Result<std::unique_ptr<Vehicle>> create(const ArmConfig& config);

  int motors() const override { return chain_.size(); }
  // Drives that report a position_rad are needed.
  void sense(std::span<const hal::DriveFeedback> feedback, TimePoint now) override;
  // Reach has no wrench for an arm; scale is the share of the wished twist that is reached.
  Reach update(const MotionWish& wish, Permit permit, Duration dt,
               std::span<hal::DriveSetpoint> setpoints) override;
  Twist<Body> own_velocity() const override;  // J·q̇ as the drives report; zero without
  void reset() override { commanded_.setZero(); }

 private:
  struct Limits {  // radians, by joint
    Joints min, max, speed, acceleration;
  };
  explicit Arm(const ArmConfig& config);

  JointBounds bounds(double seconds) const;
  Reach stop(std::span<hal::DriveSetpoint> setpoints);

  ArmChain chain_;
  Damping damping_;
  Limits limits_;
  Joints zero_, gear_, full_speed_, rest_;
  double posture_gain_;
  Duration feedback_age_;

  bool is_sensed_ = false;
  Joints angles_, speeds_;  // of the joints, as sensed
  Joints commanded_;        // rad/s
  Jacobian jacobian_;
};

}  // namespace gannet::vehicle
