#include "src/modeldb/model_facts.hpp"

#include <Eigen/LU>
#include <cmath>

#include "src/vision/symmetry.hpp"

namespace gannet::modeldb {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Pose = Transform<LeftCamera, Target>;

Vector2d place_of(const vision::PhotoPatch& p, int x, int y) {
  return {(x - p.centre_px.x()) * p.distance_m / p.fx, (y - p.centre_px.y()) * p.distance_m / p.fy};
}

// What a fixed line of sight meets of the target's plane, in the target's frame.
Vector2d meet(const Pose& pose, const Vector3d& origin, const Vector3d& ray) {
  const auto back = pose.inverse();
  const Vector3d o = back(origin), d = back.rotation * ray;
  return (o - d * (o.z() / d.z())).head<2>();
}

Pose moved(const Pose& pose, int axis, double by) {
  Pose out = pose;
  if (axis < 3) {
    out.translation[axis] += by;
  } else {
    const Vector3d turn = by * Vector3d::Unit(axis - 3);
    out.rotation = quaternion_from_rotation_vector(turn) * pose.rotation;
  }
  return out;
}

// How a place on the target under a fixed pixel slides as the pose changes: 2 × 6.
Eigen::Matrix<double, 2, 6> slide(const Pose& pose, const Vector3d& origin, const Vector3d& ray) {
  constexpr double kStep = 1e-5;
  Eigen::Matrix<double, 2, 6> out;
  for (int axis = 0; axis < 6; ++axis)
    out.col(axis) = (meet(moved(pose, axis, kStep), origin, ray) -
                     meet(moved(pose, axis, -kStep), origin, ray)) /
                    (2 * kStep);
  return out;
}

// Slopes over one camera pixel to either side (grey levels/m, 3 × 2); false: near the outline.
bool slopes(const vision::PhotoPatch& p, const Vector2d& at, double step_m,
            Eigen::Matrix<double, 3, 2>& out) {
  for (int axis = 0; axis < 2; ++axis) {
    const Vector2d step = step_m * Vector2d::Unit(axis);
    Vector3d before, behind;
    if (!vision::sample_photo(p, at - step, before) || !vision::sample_photo(p, at + step, behind))
      return false;
    out.col(axis) = (behind - before) / (2 * step_m);
  }
  return true;
}

bool inside(const Intrinsics& camera, const Vector3d& point) {
  const auto pixel = camera.project(point);
  return pixel && pixel->x() >= 0 && pixel->y() >= 0 && pixel->x() < camera.width &&
         pixel->y() < camera.height;
}

}  // namespace

std::optional<Vector6d> least_sigma(const vision::PhotoPatch& patch, const StereoRig& rig,
                                    double depth_m, double noise_grey_levels) {
  const Pose pose = {Eigen::Quaterniond::Identity(),
                     rig.hand_from_left.inverse()(Vector3d(0, 0, depth_m))};
  const auto left_from_right = rig.right_from_left.inverse();
  const double variance = noise_grey_levels * noise_grey_levels + 1.0 / 12;
  Matrix6d information = Matrix6d::Zero();
  for (int y = 0; y < patch.height; ++y) {
    for (int x = 0; x < patch.width; ++x) {
      if (patch.mask[static_cast<std::size_t>(y * patch.width + x)] == 0) continue;
      const Vector2d at = place_of(patch, x, y);
      Eigen::Matrix<double, 3, 2> slope;
      if (!slopes(patch, at, depth_m / rig.left.magnification().x(), slope)) continue;
      const Vector3d point = pose({at.x(), at.y(), 0});
      for (const bool left : {true, false}) {
        const Intrinsics& camera = left ? rig.left : rig.right;
        if (!inside(camera, left ? point : rig.right_from_left(point))) continue;
        const Vector3d origin = left ? camera.pupil() : left_from_right(camera.pupil());
        const Eigen::Matrix<double, 3, 6> j = slope * slide(pose, origin, point - origin);
        // Camera pixels for each pixel of the photo.
        const double pixels = camera.magnification().prod() / (depth_m * depth_m) *
                              patch.distance_m * patch.distance_m / (patch.fx * patch.fy);
        information += j.transpose() * j * (pixels / variance);
      }
    }
  }
  // In like units, or the rank would hang on metres beside radians.
  Vector6d scale = Vector6d::Ones();
  scale.head<3>().setConstant(depth_m);
  Eigen::FullPivLU<Matrix6d> lu(scale.asDiagonal() * information * scale.asDiagonal());
  lu.setThreshold(1e-9);
  if (!lu.isInvertible()) return std::nullopt;
  const Matrix6d inverse = lu.inverse();
  return Vector6d(inverse.diagonal().cwiseSqrt().cwiseProduct(scale));
}

}  // namespace gannet::modeldb
