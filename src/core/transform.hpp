// Transform<To, From>: a rigid motion named so that neighbours cancel, a_from_b * b_from_c =
// a_from_c; the wrong order does not compile. r_to = to_from_from * r_from. Metres. RT safe.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace gannet {

// Frames (docs/design/frames.md). Optical axes: x right, y down, z forward.
struct LeftCamera {};   // Σ_CL, optical
struct RightCamera {};  // Σ_CR, optical
struct Hand {};         // Σ_H, optical axes, midway between the cameras unless configured
struct Body {};         // vehicle, REP-103: x forward, y left, z up
struct Target {};       // Σ_M: x right, y down on the photo, z away from the photographer
struct World {};        // Σ_W, simulation and logs only

template <class To, class From>
struct Transform {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  static Transform identity() { return {}; }

  Eigen::Vector3d operator()(const Eigen::Vector3d& r_from) const {
    return rotation * r_from + translation;
  }
  Transform<From, To> inverse() const {
    const Eigen::Quaterniond back = rotation.conjugate();
    return {back, -(back * translation)};
  }
};

template <class A, class B, class C>
Transform<A, C> operator*(const Transform<A, B>& a_from_b, const Transform<B, C>& b_from_c) {
  return {(a_from_b.rotation * b_from_c.rotation).normalized(), a_from_b(b_from_c.translation)};
}

// The unit quaternion of the same rotation with scalar part >= 0.
inline Eigen::Quaterniond canonical(const Eigen::Quaterniond& q) {
  return q.w() < 0 ? Eigen::Quaterniond(-q.w(), -q.x(), -q.y(), -q.z()) : q;
}

// From a rotation vector (axis · angle, rad) and back; exact near zero.
Eigen::Quaterniond quaternion_from_rotation_vector(const Eigen::Vector3d& v);
Eigen::Vector3d rotation_vector_from_quaternion(const Eigen::Quaterniond& q);

// R = Rz(c) · Ry(b) · Rx(a), radians, and back (|b| < π/2).
Eigen::Quaterniond quaternion_from_rpy(double a, double b, double c);
Eigen::Vector3d rpy_from_quaternion(const Eigen::Quaterniond& q);

}  // namespace gannet
