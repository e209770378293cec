// A rig with ports as a calibration in water would have it that knows no ports: pinholes with
// Brown's distortion, fitted to what the cameras see of boards between two depths. The fairest
// rival of a port that is known. Tests and benches only.
#pragma once

#include <Eigen/Cholesky>
#include <vector>

#include "src/core/stereo_rig.hpp"

namespace gannet::test {

struct FoldedPort {
  StereoRig rig;                  // told from where the left pinhole was found to be
  Eigen::Vector3d left_from_rig;  // which is there in the true left frame: add to positions
  double worst_px = 0;            // what the fit leaves
};

namespace detail {

// fx fy cx cy, k1 k2 p1 p2 k3, the pinhole's place.
using PinholeParameters = Eigen::Matrix<double, 12, 1>;

inline Intrinsics pinhole_of(const PinholeParameters& p, Intrinsics camera) {
  camera.port.reset();
  camera.fx = p[0], camera.fy = p[1], camera.cx = p[2], camera.cy = p[3];
  camera.distortion = Distortion::kBrown;
  for (Eigen::Index i = 0; i < 5; ++i) camera.coefficients[static_cast<std::size_t>(i)] = p[4 + i];
  return camera;
}

struct Seen {
  Eigen::Vector3d point;
  Eigen::Vector2d pixel;
};

inline Eigen::Vector2d miss(const PinholeParameters& p, const Intrinsics& like, const Seen& seen) {
  const Intrinsics camera = pinhole_of(p, like);
  const Eigen::Vector3d from = seen.point - p.tail<3>();
  const Eigen::Vector2d n = camera.distort(from.head<2>() / from.z());
  return Eigen::Vector2d(camera.fx * n.x() + camera.cx, camera.fy * n.y() + camera.cy) - seen.pixel;
}

// Levenberg–Marquardt with differences.
inline PinholeParameters fitted(const Intrinsics& camera, const std::vector<Seen>& all) {
  const Eigen::Vector2d f = camera.magnification();
  PinholeParameters p = PinholeParameters::Zero();
  p.head<4>() << f.x(), f.y(), camera.cx, camera.cy;
  p.tail<3>() = camera.pupil();
  const auto squares = [&](const PinholeParameters& at) {
    double sum = 0;
    for (const Seen& seen : all) sum += miss(at, camera, seen).squaredNorm();
    return sum;
  };
  double damping = 1e-3, now = squares(p);
  for (int i = 0; i < 60; ++i) {
    Eigen::Matrix<double, 12, 12> h = Eigen::Matrix<double, 12, 12>::Zero();
    PinholeParameters g = PinholeParameters::Zero();
    for (const Seen& seen : all) {
      const Eigen::Vector2d r = miss(p, camera, seen);
      Eigen::Matrix<double, 2, 12> j;
      for (Eigen::Index k = 0; k < 12; ++k) {
        PinholeParameters beside = p;
        const double step = k < 4 ? 1e-3 : 1e-6;
        beside[k] += step;
        j.col(k) = (miss(beside, camera, seen) - r) / step;
      }
      h += j.transpose() * j;
      g += j.transpose() * r;
    }
    h.diagonal() *= 1 + damping;
    const PinholeParameters next = p - h.ldlt().solve(g);
    const double then = squares(next);
    if (then < now) {
      p = next, now = then, damping /= 5;
    } else {
      damping *= 10;
    }
  }
  return p;
}

}  // namespace detail

inline FoldedPort fold_ports(const StereoRig& rig, double nearest_m, double farthest_m) {
  constexpr int kColumns = 12, kRows = 9, kDepths = 3;
  FoldedPort out = {rig, {}, 0};
  Eigen::Vector3d place[2];
  for (const int eye : {0, 1}) {
    const Intrinsics& camera = eye == 0 ? rig.left : rig.right;
    std::vector<detail::Seen> all;
    for (int k = 0; k < kColumns * kRows * kDepths; ++k) {
      const Eigen::Vector2d pixel((camera.width - 1.0) * (k % kColumns) / (kColumns - 1),
                                  (camera.height - 1.0) * (k / kColumns % kRows) / (kRows - 1));
      const double z =
          nearest_m + (farthest_m - nearest_m) * (k / (kColumns * kRows)) / (kDepths - 1);
      if (const auto line = camera.line(pixel)) all.push_back({line->at_depth(z), pixel});
    }
    const detail::PinholeParameters p = detail::fitted(camera, all);
    (eye == 0 ? out.rig.left : out.rig.right) = detail::pinhole_of(p, camera);
    place[eye] = p.tail<3>();
    for (const detail::Seen& seen : all)
      out.worst_px = std::max(out.worst_px, detail::miss(p, camera, seen).norm());
  }
  out.left_from_rig = place[0];
  out.rig.right_from_left.translation = rig.right_from_left(place[0]) - place[1];
  return out;
}

}  // namespace gannet::test
