#include "src/vehicle/allocation.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace gannet::vehicle {
namespace {

Eigen::Vector3d vector_of(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

Vector6d column(const ThrusterConfig& thruster) {
  const Eigen::Vector3d direction = vector_of(thruster.direction).normalized();
  Vector6d out;
  out << direction, vector_of(thruster.position_m).cross(direction);
  return out;
}

// Metres that make torque and force comparable where not both can be had.
double lever_of(const std::vector<ThrusterConfig>& thrusters) {
  double sum = 0;
  for (const auto& t : thrusters) sum += vector_of(t.position_m).norm();
  return std::max(sum / static_cast<double>(thrusters.size()), 0.01);
}

}  // namespace

Result<Allocation> Allocation::create(const std::vector<ThrusterConfig>& thrusters,
                                      const Axes& controlled) {
  static constexpr const char* kAxes[6] = {"x", "y", "z", "roll", "pitch", "yaw"};
  const int n = static_cast<int>(thrusters.size());
  if (n < 1 || n > kMaxThrusters) {
    return Error{"vehicle.rov: " + std::to_string(n) + " thrusters is outside [1, " +
                 std::to_string(kMaxThrusters) + "]"};
  }
  Allocation a;
  a.forward_.setZero(6, n);
  a.least_.resize(n);
  a.most_.resize(n);
  for (int i = 0; i < n; ++i) {
    const auto& thruster = thrusters[static_cast<std::size_t>(i)];
    a.forward_.col(i) = column(thruster);
    a.least_[i] = thrust_of(thruster.curve, -1);
    a.most_[i] = thrust_of(thruster.curve, 1);
  }
  for (int axis = 0; axis < 6; ++axis) {
    if (!controlled[static_cast<std::size_t>(axis)]) {
      a.forward_.row(axis).setZero();
    } else if (a.forward_.row(axis).norm() < 1e-6) {
      return Error{std::string("vehicle.rov.controlled: no thruster acts on '") + kAxes[axis] +
                   "'; leave it out, or correct the thrusters"};
    }
  }
  Vector6d weight = Vector6d::Ones();
  weight.tail<3>().setConstant(1 / lever_of(thrusters));
  const Eigen::MatrixXd weighted = weight.asDiagonal() * a.forward_;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(weighted, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const auto& values = svd.singularValues();
  for (int i = 0; i < values.size(); ++i) a.rank_ += values[i] > 1e-6 * values[0];
  const Eigen::MatrixXd u = svd.matrixU().leftCols(a.rank_);
  const Eigen::MatrixXd v = svd.matrixV().leftCols(a.rank_);
  const Eigen::VectorXd s = values.head(a.rank_).cwiseInverse();
  a.inverse_ = v * s.asDiagonal() * u.transpose() * weight.asDiagonal();
  a.projector_ = weight.cwiseInverse().asDiagonal() * u * u.transpose() * weight.asDiagonal();
  return a;
}

Allocation::Share Allocation::share(const Vector6d& wish) const {
  Share out;
  out.thrusts.noalias() = inverse_ * wish;
  out.unreachable.noalias() = wish - projector_ * wish;
  for (int i = 0; i < size(); ++i) {
    const double thrust = out.thrusts[i];
    const double limit = thrust > 0 ? most_[i] : least_[i];
    if (thrust * out.scale > most_[i] || thrust * out.scale < least_[i]) {
      out.scale = limit / thrust;
    }
  }
  out.thrusts *= out.scale;
  return out;
}

Vector6d Allocation::wrench(const Thrusts& thrusts) const {
  Vector6d out;
  out.noalias() = forward_ * thrusts;
  return out;
}

}  // namespace gannet::vehicle
