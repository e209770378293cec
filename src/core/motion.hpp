// Motion of a rigid body as values: velocities and what servo asks of a vehicle. SI. RT safe.
#pragma once

#include <Eigen/Core>

#include "src/core/transform.hpp"

namespace gannet {

// Velocity of frame F, expressed in F: linear m/s, angular rad/s.
template <class F>
struct Twist {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();
};

// Force and torque on frame F, expressed in F: N, N·m.
template <class F>
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
};

// The twist of a frame A that is rigidly joined to B.
template <class A, class B>
Twist<A> joined_twist(const Transform<A, B>& a_from_b, const Twist<B>& twist) {
  const Eigen::Vector3d angular = a_from_b.rotation * twist.angular;
  return {a_from_b.rotation * twist.linear + a_from_b.translation.cross(angular), angular};
}

// What servo asks of the vehicle, in the body's frame (x forward, y left, z up). velocity is
// relative to the water or floor as far as it can be told; measured is the present velocity in the
// same sense, from what the filter sees of the target, for vehicles that close a velocity loop.
struct MotionWish {
  Twist<Body> velocity;
  Twist<Body> measured;
  bool measured_valid = false;
};

}  // namespace gannet
