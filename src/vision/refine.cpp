#include "src/vision/refine.hpp"

#include <algorithm>
#include <cmath>

#include "src/vision/refine_problem.hpp"

namespace gannet::vision {
namespace {

template <int P>
bool solve(const Matrix<double, P, P>& hessian, const Matrix<double, P, 1>& slope,
           Matrix<double, P, 1>& step) {
  // A little damping relative to each parameter's own curvature: weak directions stay put.
  Matrix<double, P, P> damped = hessian;
  damped.diagonal() *= 1 + 1e-3;
  const Eigen::LDLT<Matrix<double, P, P>> ldlt(damped);
  if (ldlt.info() != Eigen::Success || !ldlt.isPositive()) return false;
  step = -ldlt.solve(slope);
  return step.allFinite();
}

}  // namespace

Refinement refine_pose(const RigOptics& optics, const PointSet& points, const PreparedFrame& frame,
                       const Transform<LeftCamera, Target>& start, const RefineOptions& options) {
  Refinement out = {false, start, Matrix6d::Zero(), {}};
  Problem<6> problem = {optics, points, frame, options};
  Matrix6d hessian;
  Vector6d slope, step;
  // A first pass without weights fits gains and variances for the weights of the next.
  for (int k = 0; k <= options.iterations; ++k) {
    if (!problem.accumulate(eye_at(out.left_from_target), hessian, slope) ||
        !solve<6>(hessian, slope, step)) {
      return out;
    }
    out.looks = problem.core_fits;
    const double sigmas2 = step.dot(hessian * step) / options.shared_noise;
    if (k == options.iterations) break;
    // A step is at most a few pixels: further away the gradients say nothing.
    const double z = out.left_from_target.translation.z();
    const double scale =
        std::min(1.0, std::min(0.02 * z / step.head<3>().norm(), 0.15 / step.tail<3>().norm()));
    step *= scale;
    out.left_from_target.translation += step.head<3>();
    const Vector3d turn = step.tail<3>();
    out.left_from_target.rotation =
        (quaternion_from_rotation_vector(turn) * out.left_from_target.rotation).normalized();
    if (k > 0 && sigmas2 < options.sigmas_stop * options.sigmas_stop) break;
  }
  out.ok = invert<6>(hessian, options.shared_noise, out.covariance) &&
           out.left_from_target.translation.z() > 0;
  out.left_from_target.rotation = canonical(out.left_from_target.rotation);
  return out;
}

Transform<LeftCamera, Target> pose_of_plane(const Vector3d& n_over_d, const Vector3d& ray) {
  return {canonical(Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), n_over_d)),
          ray / n_over_d.dot(ray)};
}

Refinement refine_plane(const RigOptics& optics, const PointSet& points, const PreparedFrame& frame,
                        const Transform<LeftCamera, Target>& start, const Vector3d& centre,
                        const RefineOptions& options) {
  Refinement out = {false, start, Matrix6d::Zero(), {}};
  const Vector3d normal = start.rotation * Vector3d::UnitZ();
  Vector3d plane = normal / normal.dot(start.translation);
  Problem<3> problem = {optics, points, frame, options};
  Eigen::Matrix3d hessian;
  Vector3d slope, step;
  for (int k = 0; k <= options.iterations; ++k) {
    const auto of_eye = [&](RefineEye& eye, const Eigen::Matrix3d& r, const Vector3d& t) {
      set(eye.h, r);
      set(eye.arm, t);
      set(eye.plane, plane);
    };
    if (!problem.accumulate(of_eye, hessian, slope) || !solve<3>(hessian, slope, step)) {
      return out;
    }
    const double sigmas2 = step.dot(hessian * step) / options.shared_noise;
    if (k == options.iterations) break;
    const double change = std::abs(step.dot(centre)) / plane.dot(centre);
    step *= std::min(1.0, 0.03 / std::max(change, 1e-12));
    plane += step;
    if (plane.dot(centre) <= 0) return out;
    if (k > 0 && sigmas2 < options.sigmas_stop * options.sigmas_stop) break;
  }
  Eigen::Matrix3d covariance;
  if (!invert<3>(hessian, options.shared_noise, covariance)) return out;
  out.left_from_target = pose_of_plane(plane, centre);
  // To the pose's six by differences; rotation as a small vector in the left camera's frame.
  Matrix<double, 6, 3> by_plane;
  for (int k = 0; k < 3; ++k) {
    const double h = 1e-6 * plane.norm();
    const auto moved = pose_of_plane(plane + h * Vector3d::Unit(k), centre);
    by_plane.col(k).head<3>() = (moved.translation - out.left_from_target.translation) / h;
    by_plane.col(k).tail<3>() = rotation_vector_from_quaternion(
                                    moved.rotation * out.left_from_target.rotation.conjugate()) /
                                h;
  }
  out.covariance = by_plane * covariance * by_plane.transpose();
  out.ok = true;
  return out;
}

}  // namespace gannet::vision
