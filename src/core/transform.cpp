#include "src/core/transform.hpp"

#include <algorithm>
#include <cmath>

namespace gannet {

Eigen::Quaterniond quaternion_from_rotation_vector(const Eigen::Vector3d& v) {
  const double angle = v.norm();
  // sin(x/2)/x by its series where the quotient loses digits.
  const double s = angle < 1e-6 ? 0.5 - angle * angle / 48 : std::sin(angle / 2) / angle;
  return {std::cos(angle / 2), s * v.x(), s * v.y(), s * v.z()};
}

Eigen::Vector3d rotation_vector_from_quaternion(const Eigen::Quaterniond& q_any) {
  const Eigen::Quaterniond q = canonical(q_any);
  const double sine = q.vec().norm();
  if (sine < 1e-9) return 2 * q.vec();
  return 2 * std::atan2(sine, q.w()) / sine * q.vec();
}

Eigen::Quaterniond quaternion_from_rpy(double a, double b, double c) {
  return Eigen::AngleAxisd(c, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(b, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(a, Eigen::Vector3d::UnitX());
}

Eigen::Vector3d rpy_from_quaternion(const Eigen::Quaterniond& q) {
  const Eigen::Matrix3d r = q.toRotationMatrix();
  return {std::atan2(r(2, 1), r(2, 2)), std::asin(std::clamp(-r(2, 0), -1.0, 1.0)),
          std::atan2(r(1, 0), r(0, 0))};
}

}  // namespace gannet
