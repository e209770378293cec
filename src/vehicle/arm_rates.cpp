#include "src/vehicle/arm_rates.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace gannet::vehicle {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

Vector6d weights(const Damping& damping) {
  Vector6d w = Vector6d::Ones();
  w.tail<3>() *= damping.radian_as_m;
  return w;
}

// (σ² + λ²)⁻¹ along each left singular vector of a weighed Jacobian.
class DampedInverse {
 public:
  DampedInverse(const Jacobian& weighed, const Damping& damping) {
    const Matrix6d gram = weighed * weighed.transpose();
    const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(gram);
    Vector6d inverse = Vector6d::Zero();
    const double edge = damping.singular_below * damping.singular_below;
    for (int i = 0; i < 6; ++i) {
      const double squared = std::max(0.0, solver.eigenvalues()[i]);
      const double damped = squared < edge ? (1 - squared / edge) * damping.most * damping.most : 0;
      // Below it there is only rounding: a direction in which nothing can be done.
      if (squared + damped > 1e-12) inverse[i] = 1 / (squared + damped);
    }
    inverse_ = solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
  }
  Joints solve(const Jacobian& weighed, const Vector6d& task) const {
    return weighed.transpose() * (inverse_ * task);
  }

 private:
  Matrix6d inverse_;
};

// The joint that is farthest beyond its bounds, of those that are free; −1: none.
int worst(const Joints& rates, const JointBounds& bounds, const Joints& is_free) {
  int found = -1;
  double most = 1e-9;
  for (int i = 0; i < rates.size(); ++i) {
    const double beyond = std::max(rates[i] - bounds.most[i], bounds.least[i] - rates[i]);
    if (is_free[i] == 0 || beyond <= most) continue;
    most = beyond;
    found = i;
  }
  return found;
}

}  // namespace

Joints joint_rates(const Jacobian& jacobian, const Vector6d& twist, const Joints& posture,
                   const JointBounds& bounds, const Damping& damping) {
  const Vector6d w = weights(damping);
  Jacobian weighed = w.asDiagonal() * jacobian;
  Vector6d task = w.cwiseProduct(twist);
  Joints rates = Joints::Zero(posture.size());
  Joints is_free = Joints::Ones(posture.size());
  for (int round = 0; round < posture.size(); ++round) {
    const DampedInverse inverse(weighed, damping);
    const Joints wanted = posture.cwiseProduct(is_free);
    const Joints moved = wanted + inverse.solve(weighed, task - weighed * wanted);
    for (int i = 0; i < rates.size(); ++i)
      if (is_free[i] != 0) rates[i] = moved[i];
    const int at = worst(rates, bounds, is_free);
    if (at < 0) return rates;
    rates[at] = std::clamp(rates[at], bounds.least[at], bounds.most[at]);
    is_free[at] = 0;
    task -= rates[at] * weighed.col(at);
    weighed.col(at).setZero();
  }
  return rates.cwiseMax(bounds.least).cwiseMin(bounds.most);
}

double least_singular_value(const Jacobian& jacobian, const Damping& damping) {
  const Jacobian weighed = weights(damping).asDiagonal() * jacobian;
  const Matrix6d gram = weighed * weighed.transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(gram, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
}

}  // namespace gannet::vehicle
