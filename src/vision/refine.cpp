#include "src/vision/refine.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "src/vision/bent_points.hpp"
#include "src/vision/kernels/refine_sums.hpp"

namespace gannet::vision {
namespace {

using Eigen::Matrix;
using Eigen::Vector2d;
using Eigen::Vector3d;

// A camera scaled to a level of the pyramid.
Intrinsics at_level(Intrinsics camera, int level) {
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

void set(float* to, const Eigen::Matrix3d& m) {
  for (int k = 0; k < 9; ++k) to[k] = static_cast<float>(m(k / 3, k % 3));
}
void set(float* to, const Vector3d& v) {
  for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(v(k));
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

 private:
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
    const Eigen::Matrix3d rotation = out.left_from_target.rotation.toRotationMatrix();
    const auto of_eye = [&](RefineEye& eye, const Eigen::Matrix3d& r, const Vector3d& t) {
      Eigen::Matrix3d h = r * rotation;
      h.col(2) = r * out.left_from_target.translation + t;
      set(eye.h, h);
      set(eye.deep, Vector3d(r * rotation.col(2)));
      for (int axis = 0; axis < 3; ++axis) set(eye.arm + 3 * axis, Vector3d(rotation.col(axis)));
    };
    if (!problem.accumulate(of_eye, hessian, slope) || !solve<6>(hessian, slope, step)) {
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
