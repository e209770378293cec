// FlatPort: the flat window of an underwater housing before a camera: air, glass, water, each
// bounded by a plane across one axis, so that light from the camera's centre is bent twice (Snell)
// and no longer meets in one point: Agrawal, Ramalingam, Taguchi, Chari, "A theory of multi-layer
// flat refractive geometry", CVPR 2012. Parameters as calibmar's FLATPORT has them. Camera's
// optical frame, metres. A value after loading; RT safe, any thread.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace gannet {

// Where light goes: origin + t · direction.
struct Line {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  // z = 1

  Eigen::Vector3d at_depth(double z) const { return origin + direction * (z - origin.z()); }
  // Where it meets the plane normal · p = distance.
  Eigen::Vector3d at_plane(const Eigen::Vector3d& normal, double distance) const {
    return origin + direction * (distance - normal.dot(origin)) / normal.dot(direction);
  }
};

struct FlatPort {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, from the camera into the water
  double distance_m = 0.02;  // from the camera's centre to the glass, along the normal
  double thickness_m = 0.01;
  double air_index = 1.0;  // of refraction
  double glass_index = 1.49;
  double water_index = 1.333;

  // The direction in air, seen from the camera's centre, of a point in the water; empty where the
  // point is not beyond the glass. Exact: Newton's method from the side where it cannot miss.
  std::optional<Eigen::Vector3d> air_ray(const Eigen::Vector3d& point) const;

  // The line in water, from the outer face on, of a direction in air; empty where the light does
  // not meet the glass, is reflected wholly, or runs away from the camera's front.
  std::optional<Line> line(const Eigen::Vector3d& air_ray) const;

  // Where on the axis lines near the axis meet: along the normal from the camera's centre, metres.
  double pupil_m() const;
};

}  // namespace gannet
