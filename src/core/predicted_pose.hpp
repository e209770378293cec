// PredictedPose: where a target is now, as the pose filter says between and after the late images.
// All in the left camera's optical axes; SI. A value of the servo thread; RT safe.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "platform/base/time.hpp"
#include "src/core/transform.hpp"

namespace gannet {

using Matrix12d = Eigen::Matrix<double, 12, 12>;

// Linear m/s of the target's origin and angular rad/s, in the left camera's axes.
struct TargetVelocity {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();
};

struct PredictedPose {
  bool valid = false;  // false: nothing below means anything
  std::uint32_t target_id = 0;
  TimePoint time = {};  // what it is predicted to
  Duration age = {};    // time − capture of the newest image that went into it
  Transform<LeftCamera, Target> left_from_target;
  TargetVelocity relative;  // as the camera sees it: the rate of left_from_target
  TargetVelocity target;    // the target's own, the camera's motion taken out
  // Of (position, rotation vector, target's linear, angular velocity), each in camera axes;
  // m², rad², (m/s)², (rad/s)².
  Matrix12d covariance = Matrix12d::Zero();
};

}  // namespace gannet
