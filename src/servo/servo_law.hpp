// ServoLaw: from where the target is to how the vehicle shall move. Kinds beside this interface;
// create_servo_law lists them. The integral part is not here but in the vehicle's velocity loop,
// for only the vehicle knows what its motors could not do, which anti-windup needs.
// Servo thread; RT safe after creation. The caller owns the law.
#pragma once

#include <memory>

#include "platform/base/result.hpp"
#include "platform/base/time.hpp"
#include "src/core/motion.hpp"
#include "src/core/permit.hpp"
#include "src/core/predicted_pose.hpp"
#include "src/core/stereo_rig.hpp"
#include "src/servo/servo_config.hpp"

namespace gannet::servo {

// What was asked and how far off it is; for records, checks and release conditions.
struct ServoError {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();    // target minus goal, Σ_H
  Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();  // rotation vector, Σ_H
};

class ServoLaw {
 public:
  virtual ~ServoLaw() = default;

  // One cycle. Without full permit or without a valid prediction the wish is zero velocity.
  virtual MotionWish update(const PredictedPose& target, const Goal& goal, Permit permit,
                            Duration dt) = 0;
  virtual ServoError error() const = 0;             // of the newest update
  virtual void set(const ServoParams& params) = 0;  // from the next update on
};

// An unknown law, or a rig without body_from_hand, is an error. Start-up only.
Result<std::unique_ptr<ServoLaw>> create_servo_law(const ServoConfig& config, const StereoRig& rig);

}  // namespace gannet::servo
