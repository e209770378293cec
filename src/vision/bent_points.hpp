// BentPoints: where a lens and a flat port bring points to in the image, and how the pixels move,
// for the refinement's kernels; many points at once and without branches, so that the compiler can
// do them side by side. RT safe: IEEE arithmetic alone but for the fisheye's arc tangent.
#pragma once

#include <array>

#include "src/core/stereo_rig.hpp"
#include "src/vision/kernels/refine_sums.hpp"
#include "src/vision/port_optics.hpp"

namespace gannet::vision {

class BentPoints {
 public:
  static constexpr int kMost = 256;  // points of one part

  // camera: at the level; radius2: normalised, up to which its lens is one-to-one; port: null
  // without one. Both are borrowed.
  BentPoints(const Intrinsics& camera, double radius2, const PortOptics* port)
      : camera_(camera), port_(port), radius2_(radius2) {}
  static bool bends(const Intrinsics& camera) {
    return camera.distortion != Distortion::kNone || camera.port;
  }

  // Of a part's points, told from the port's pupil or the camera's centre. rays: they are rays of
  // the left camera that meet the eye's plane. Pixels that nothing is seen at are NaN.
  void fill(const RefineEye& eye, const RefinePart& part, bool rays);
  LensPart part() const;

 private:
  using Row = std::array<float, kMost>;
  void place(const RefineEye& eye, const RefinePart& part, bool rays);
  void pass_port(int n);
  void normalise(int n);
  void distort_brown(int n);
  void distort_fisheye(int n);
  void to_pixels(int n);

  const Intrinsics& camera_;
  const PortOptics* port_;
  double radius2_;
  // Points, then directions in air; of the latter what a move of the point along x and y adds to
  // them along the port's axis.
  alignas(32) Row x_, y_, z_, depth_, turn_x_, turn_y_;
  alignas(32) Row u_, v_;
  alignas(32) std::array<Row, 4> slopes_;  // du/da, du/db, dv/da, dv/db
};

}  // namespace gannet::vision
