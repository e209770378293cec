// Hypothesis: where the target's plane might be, and how each camera would see it. Plain arithmetic
// in a fixed order (no Eigen, no libm), so that a search takes the same path on every machine.
// A value; RT safe.
#pragma once

#include <array>

#include "src/core/stereo_rig.hpp"
#include "src/vision/kernels/kernels.hpp"
#include "src/vision/port_optics.hpp"

namespace gannet::vision {

// left_from_target: rotation row by row and translation in metres.
struct Hypothesis {
  std::array<double, 9> rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<double, 3> translation = {0, 0, 1};

  Transform<LeftCamera, Target> pose() const;
  static Hypothesis from(const Transform<LeftCamera, Target>& pose);
};

// A camera as the kernels want it: extrinsics from the left camera and a projection for each level
// of the pyramid. Made once from the rig, start-up only; reading is RT safe.
class CameraModel {
 public:
  CameraModel(const Intrinsics& intrinsics, const Transform<RightCamera, LeftCamera>* from_left);

  // The view of the target's plane at a hypothesis, on a plane scaled by 2^−level. reach: how far
  // from (0, 0) points are; behind a port all of them must be beyond its glass.
  PlaneView view(const Hypothesis& hypothesis, float reach, int level, int width, int height,
                 int guard) const;
  // The view, in this camera, of what lies on the hypothesis's plane behind rays (x, y, 1) of the
  // left camera: the homography that the plane induces (P004 §3.2).
  PlaneView ray_view(const Hypothesis& hypothesis, float reach, int level, int width, int height,
                     int guard) const;

  bool has_port() const { return intrinsics_.port.has_value(); }
  bool has_lens() const { return intrinsics_.distortion != Distortion::kNone; }
  const LensTable& lens(int level) const { return lens_[static_cast<std::size_t>(level)]; }

  int project(const Kernels& kernels, const float* x, const float* y, int n, const PlaneView& view,
              int level, std::int32_t* index) const {
    if (has_port()) {
      return has_lens() ? kernels.project_port_lens(x, y, n, view, lens(level), index)
                        : kernels.project_port(x, y, n, view, index);
    }
    return has_lens() ? kernels.project_lens(x, y, n, view, lens(level), index)
                      : kernels.project(x, y, n, view, index);
  }

 private:
  // Points of a plane in this camera: (g · m) / (scale · m), m = (x, y, 1).
  struct Plane {
    std::array<double, 9> g;
    std::array<double, 3> scale = {0, 0, 1};
    std::array<double, 3> middle;  // of the points
    float reach;
  };
  PlaneView finish(const Plane& plane, int level, int width, int height, int guard) const;
  void add_port(const Plane& plane, PlaneView& view, std::array<double, 9>& g) const;

  Intrinsics intrinsics_;
  std::array<double, 9> rotation_ = {1, 0, 0, 0, 1, 0, 0, 0, 1};  // camera from left
  std::array<double, 3> translation_ = {0, 0, 0};
  std::array<LensTable, 4> lens_ = {};  // per level
  PortOptics port_;
};

}  // namespace gannet::vision
