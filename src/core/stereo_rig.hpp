// StereoRig: two calibrated cameras. Projects points and directions; never warps images.
// Pixel (0, 0) is the centre of the first pixel. A value after loading; RT safe.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/result.hpp"
#include "platform/base/time.hpp"
#include "src/core/flat_port.hpp"
#include "src/core/transform.hpp"

namespace gannet {

enum class Distortion { kNone, kBrown, kFisheye };

struct Intrinsics {
  int width = 0;  // pixels
  int height = 0;
  double fx = 0;  // pixels
  double fy = 0;
  double cx = 0;
  double cy = 0;
  Distortion distortion = Distortion::kNone;
  // brown: k1 k2 p1 p2 k3 (Brown–Conrady, OpenCV's order); fisheye: k1 k2 k3 k4 (Kannala–Brandt)
  std::array<double, 5> coefficients = {};
  Duration time_offset = {};  // added to the driver's stamp
  std::optional<FlatPort> port =
      std::nullopt;  // what the camera looks through, in its optical frame

  // Pixel of a point in the camera's optical frame (metres), through port and lens; empty when it
  // is behind the camera or the port, or beyond where the distortion model is one-to-one.
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point) const;
  // Where the points are that a pixel may show; the inverse of project. Without a port from the
  // camera's centre; with one from the outer face of its glass, empty where no light comes from:
  // in no pixel of a rig that passed check().
  std::optional<Line> line(const Eigen::Vector2d& pixel) const;
  // The lens alone. project_ray: pixel of a direction in air. ray: (x, y, 1) through a pixel; its
  // inverse, by iteration.
  std::optional<Eigen::Vector2d> project_ray(const Eigen::Vector3d& direction) const;
  Eigen::Vector3d ray(const Eigen::Vector2d& pixel) const;
  // Distorted normalised coordinates of undistorted ones.
  Eigen::Vector2d distort(const Eigen::Vector2d& normalised) const;
  // Pixels that a thing near the axis is wide, times its distance over its width: fx and fy, and
  // more of them in water behind a port.
  Eigen::Vector2d magnification() const;
  // Where lines near the axis meet, in the optical frame: the camera's centre, or before or behind
  // it where a port bends them.
  Eigen::Vector3d pupil() const;
  // The largest radius (normalised, undistorted) up to which distort is one-to-one.
  double valid_radius() const;
};

struct StereoRig {
  Intrinsics left;
  Intrinsics right;
  Transform<RightCamera, LeftCamera> right_from_left;
  // Σ_H: midway between the cameras, axes of the left one, unless the file says otherwise.
  Transform<Hand, LeftCamera> hand_from_left;
  std::optional<Transform<Body, Hand>> body_from_hand;

  double baseline_m() const { return right_from_left.translation.norm(); }
};

// What is not physical in a rig, by the key of the RIG file that says it ("left.fx"): sizes, focal
// lengths, distortion that folds inside the image, rotations, baseline.
struct RigProblem {
  std::string key;
  std::string text;
};
std::vector<RigProblem> problems_of(const StereoRig& rig);

// The same as one error, a line each.
Result<void> check(const StereoRig& rig);

}  // namespace gannet
