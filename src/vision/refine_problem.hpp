// What the refinement and the likeness share: one pass over the points of both eyes, and what its
// sums say. Internal to the vision room; RT safe.
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>

#include "src/vision/bent_points.hpp"
#include "src/vision/kernels/refine_sums.hpp"
#include "src/vision/refine.hpp"

namespace gannet::vision {

using Eigen::Matrix;
using Eigen::Vector3d;

// A camera scaled to a level of the pyramid.
inline Intrinsics at_level(Intrinsics camera, int level) {
  const double scale = 1.0 / (1 << level);
  camera.fx *= scale;
  camera.fy *= scale;
  camera.cx = (camera.cx + 0.5) * scale - 0.5;
  camera.cy = (camera.cy + 0.5) * scale - 0.5;
  return camera;
}

// Weighted sums of one channel of one eye: residuals I − a·M − b and their derivatives by P
// parameters, with a and b eliminated at the end.
template <int P>
struct ChannelSums {
  double w, m, mm, i, im, ii;
  Matrix<double, P, 1> j, jm, ji;
  Matrix<double, P, P> jj;

  // Lanes are added in a fixed order.
  explicit ChannelSums(const float (*lanes)[kSumLanes]) {
    const auto next = [&lanes] {
      const float* const l = *lanes++;
      const auto of = [l](int k) { return static_cast<double>(l[k]); };
      return ((of(0) + of(1)) + (of(2) + of(3))) + ((of(4) + of(5)) + (of(6) + of(7)));
    };
    for (double* sum : {&w, &m, &mm, &i, &im, &ii}) *sum = next();
    for (auto* sum : {&j, &jm, &ji}) {
      for (int k = 0; k < P; ++k) (*sum)(k) = next();
    }
    for (int k = 0; k < P; ++k) {
      for (int l = k; l < P; ++l) jj(l, k) = jj(k, l) = next();
    }
  }

  using Fit = Refinement::Look;
  Fit fit() const {
    const double det = w * mm - m * m;
    if (w < 8 || det <= 1e-6 * w * mm) return {};
    Fit f;
    f.gain = (w * im - m * i) / det;
    f.offset = (i - f.gain * m) / w;
    f.variance = std::max((ii - f.gain * im - f.offset * i) / w, 0.05);
    f.ok = f.gain > 0;
    return f;
  }
  // Normal equations of the step after elimination: jj −= projections on 1 and M.
  void eliminate(const Fit& f, Matrix<double, P, P>& hessian, Matrix<double, P, 1>& slope) const {
    const Matrix<double, P, 1> residual = ji - f.gain * jm - f.offset * j;
    const double var_m = mm - m * m / w;
    const Matrix<double, P, 1> along = jm - j * (m / w);
    hessian += (jj - j * j.transpose() / w - along * along.transpose() / var_m) / f.variance;
    slope += residual / f.variance;  // residuals are orthogonal to 1 and M already
  }
};

inline void set(float* to, const Eigen::Matrix3d& m) {
  for (int k = 0; k < 9; ++k) to[k] = static_cast<float>(m(k / 3, k % 3));
}
inline void set(float* to, const Vector3d& v) {
  for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(v(k));
}

// What tells Problem<6> the pose of an eye.
inline auto eye_at(const Transform<LeftCamera, Target>& pose) {
  return [&pose, rotation = pose.rotation.toRotationMatrix().eval()](
             RefineEye& eye, const Eigen::Matrix3d& r, const Vector3d& t) {
    Eigen::Matrix3d h = r * rotation;
    h.col(2) = r * pose.translation + t;
    set(eye.h, h);
    set(eye.deep, Vector3d(r * rotation.col(2)));
    for (int axis = 0; axis < 3; ++axis) set(eye.arm + 3 * axis, Vector3d(rotation.col(axis)));
  };
}

template <int P>
bool invert(const Matrix<double, P, P>& hessian, double factor, Matrix<double, P, P>& covariance) {
  const Eigen::LDLT<Matrix<double, P, P>> ldlt(hessian);
  if (ldlt.info() != Eigen::Success || ldlt.vectorD().minCoeff() <= 0) return false;
  covariance = factor * ldlt.solve(Matrix<double, P, P>::Identity());
  return covariance.allFinite();
}

template <int P>
struct Problem {
  const RigOptics& optics;
  const PointSet& points;
  const PreparedFrame& frame;
  const RefineOptions& options;
  const RefineKernels& kernels = refine_kernels();
  using Fits = std::array<Refinement::Look, 6>;
  Fits fits = {}, core_fits = {};
  bool core_only = false;

  struct Normal {
    Matrix<double, P, P> hessian = Matrix<double, P, P>::Zero();
    Matrix<double, P, 1> slope = Matrix<double, P, 1>::Zero();
    Fits fits = {};
    int channels = 0;

    void add(const RefineSums<P>& sums, std::size_t first) {
      for (std::size_t c = 0; c < 3; ++c) {
        const ChannelSums<P> channel(sums.lanes[c]);
        auto& fit = fits[first + c] = channel.fit();
        if (!fit.ok) continue;
        channel.eliminate(fit, hessian, slope);
        ++channels;
      }
    }
  };

  // One pass; of_eye(eye, rotation, translation) tells the pose, rotation and translation being the
  // camera's from the left one.
  template <class OfEye>
  bool accumulate(OfEye&& of_eye, Matrix<double, P, P>& hessian, Matrix<double, P, 1>& slope) {
    const StereoRig& rig = optics.rig;
    const bool split = P == 6 && options.level == 0 && points.core > 0;
    Normal all, core;
    for (int at = P == 6 ? 0 : 1; at < 2; ++at) {
      const bool right = at == 1;
      const Intrinsics camera = at_level(right ? rig.right : rig.left, options.level);
      const RefineEye eye = eye_of(right, camera, of_eye);
      const auto first = 3 * static_cast<std::size_t>(at);
      RefineSums<P> sums;
      if (split) {
        add(right, camera, eye, 0, points.core, 1, sums);
        core.add(sums, first);
        if (core_only) continue;
      }
      add(right, camera, eye, split ? points.core : 0, points.inside_padded, 1, sums);
      add(right, camera, eye, points.inside_padded, points.total_padded,
          static_cast<float>(options.outside_weight), sums);
      all.add(sums, first);
    }
    // The first pass has no weights yet and may be far off.
    if (split && !core_only && weighted) core_only = suffices(core.hessian, all.hessian);
    weighted = true;
    const Normal& normal = core_only ? core : all;
    fits = normal.fits;
    core_fits = split ? core.fits : all.fits;
    hessian = normal.hessian;
    slope = normal.slope;
    return normal.channels > 0;
  }

  bool weighted = false;

  template <class OfEye>
  RefineEye eye_of(bool right, const Intrinsics& camera, OfEye&& of_eye) const {
    const StereoRig& rig = optics.rig;
    const Eigen::Matrix3d rotation = right ? rig.right_from_left.rotation.toRotationMatrix()
                                           : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
    RefineEye eye = {};
    of_eye(eye, rotation, right ? rig.right_from_left.translation : Vector3d(Vector3d::Zero()));
    if (camera.port) {  // points are told from its pupil
      const auto& pupil = (right ? optics.right : optics.left).pupil();
      for (std::size_t k = 0; k < 3; ++k)
        (P == 6 ? eye.h[3 * k + 2] : eye.arm[k]) -= static_cast<float>(pupil[k]);
    }
    set(eye.turn, Eigen::Matrix3d(rotation.transpose()));
    eye.fx = static_cast<float>(camera.fx), eye.fy = static_cast<float>(camera.fy);
    eye.cx = static_cast<float>(camera.cx), eye.cy = static_cast<float>(camera.cy);
    const PackedPlane& plane =
        (right ? frame.right() : frame.left()).packed[static_cast<std::size_t>(options.level)];
    eye.width = plane.width, eye.height = plane.height;
    for (std::size_t c = 0; c < 3; ++c) {
      eye.smooth[c] = plane.smooth[c];
      const auto& fit = fits[(right ? 3 : 0) + c];
      if (!fit.ok) continue;
      // The kernels' values are less 128. Cauchy at 2.4 σ.
      eye.fit[c] = {static_cast<float>(fit.gain), static_cast<float>(fit.offset),
                    static_cast<float>(1 / (6 * fit.variance))};
    }
    return eye;
  }

  // Whether no standard deviation of the core alone is much larger than with all points.
  bool suffices(const Matrix<double, P, P>& core, const Matrix<double, P, P>& all) const {
    Matrix<double, P, P> by_core, by_all;
    if (!invert<P>(core, 1, by_core) || !invert<P>(all, 1, by_all)) return false;
    const double most = options.core_suffices * options.core_suffices;
    return (by_core.diagonal().array() <= most * by_all.diagonal().array()).all();
  }

  void add(bool right, const Intrinsics& camera, const RefineEye& eye, int begin, int end,
           float weight, RefineSums<P>& sums) const {
    const bool bends = BentPoints::bends(camera);
    BentPoints bent(camera, right ? optics.right_radius2 : optics.left_radius2,
                    camera.port ? right ? &optics.right : &optics.left : nullptr);
    const LensPart lens = bent.part();
    static_assert(sizeof(Yuv) == 3 * sizeof(float));
    const int step = bends ? BentPoints::kMost : end - begin;
    for (int first = begin; first < end; first += step) {
      const auto k = static_cast<std::size_t>(first);
      RefinePart part = {points.x.data() + k,
                         points.y.data() + k,
                         points.z.empty() ? nullptr : points.z.data() + k,
                         &points.colour.data()[k].y,
                         std::min(step, end - first),
                         weight,
                         nullptr};
      if (bends) {
        bent.fill(eye, part, P == 3);
        part.lens = &lens;
      }
      if constexpr (P == 6) {
        kernels.add_pose(eye, part, sums);
      } else {
        kernels.add_plane(eye, part, sums);
      }
    }
  }
};

}  // namespace gannet::vision
