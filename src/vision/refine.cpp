#include "src/vision/refine.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace gannet::vision {
namespace {

using Eigen::Matrix;
using Eigen::Vector2d;
using Eigen::Vector3d;

// A camera's pixel of a point and its derivative.
struct Projection {
  Vector2d pixel;
  Matrix<double, 2, 3> by_point;
};

bool project(const Intrinsics& camera, const Vector3d& p, Projection& out) {
  if (p.z() <= 1e-6) return false;
  const double x = p.x() / p.z();
  const double y = p.y() / p.z();
  Matrix<double, 2, 3> normalised;
  normalised << 1 / p.z(), 0, -x / p.z(), 0, 1 / p.z(), -y / p.z();
  Vector2d at(x, y);
  Eigen::Matrix2d lens = Eigen::Matrix2d::Identity();
  if (camera.distortion != Distortion::kNone) {
    if (at.squaredNorm() > camera.valid_radius() * camera.valid_radius()) return false;
    constexpr double kStep = 1e-6;
    lens.col(0) = (camera.distort({x + kStep, y}) - camera.distort({x - kStep, y})) / (2 * kStep);
    lens.col(1) = (camera.distort({x, y + kStep}) - camera.distort({x, y - kStep})) / (2 * kStep);
    at = camera.distort(at);
  }
  out.pixel = {camera.fx * at.x() + camera.cx, camera.fy * at.y() + camera.cy};
  out.by_point = Vector2d(camera.fx, camera.fy).asDiagonal() * lens * normalised;
  return true;
}

struct Sample {
  double value;
  Vector2d gradient;  // per pixel
};

// A place between four pixels, the same in each channel's plane.
class Place {
 public:
  // False: too near to the border, or outside.
  bool set(int width, int height, const Vector2d& at) {
    if (!(at.x() >= 1 && at.y() >= 1 && at.x() < width - 2 && at.y() < height - 2)) return false;
    const int x = static_cast<int>(at.x()), y = static_cast<int>(at.y());
    a_ = at.x() - x;
    b_ = at.y() - y;
    width_ = width;
    offset_ = y * width + x;
    return true;
  }
  // Bilinear value; gradient of central differences, bilinear too.
  Sample sample(const std::uint8_t* plane) const {
    const std::uint8_t* p = plane + offset_;
    const int w = width_;
    const auto mix = [&](auto&& f) {
      return (1 - b_) * ((1 - a_) * f(p) + a_ * f(p + 1)) +
             b_ * ((1 - a_) * f(p + w) + a_ * f(p + w + 1));
    };
    Sample out;
    out.value = mix([](const std::uint8_t* q) { return static_cast<double>(*q); });
    out.gradient.x() = mix([](const std::uint8_t* q) { return 0.5 * (q[1] - q[-1]); });
    out.gradient.y() = mix([w](const std::uint8_t* q) { return 0.5 * (q[w] - q[-w]); });
    return out;
  }

 private:
  double a_ = 0, b_ = 0;
  int width_ = 0, offset_ = 0;
};

// Weighted sums of one channel of one eye: residuals I − a·M − b and their derivatives by P
// parameters, with a and b eliminated at the end.
template <int P>
struct ChannelSums {
  double w = 0, m = 0, mm = 0, i = 0, im = 0, ii = 0;
  Matrix<double, P, 1> j = Matrix<double, P, 1>::Zero(), jm = j, ji = j;
  Matrix<double, P, P> jj = Matrix<double, P, P>::Zero();  // the lower half

  void add(double weight, double model, double image, const Matrix<double, P, 1>& slope) {
    w += weight;
    m += weight * model;
    mm += weight * model * model;
    i += weight * image;
    im += weight * image * model;
    ii += weight * image * image;
    j += weight * slope;
    jm += weight * model * slope;
    ji += weight * image * slope;
    const Matrix<double, P, 1> weighted = weight * slope;
    for (int col = 0; col < P; ++col) {
      for (int row = col; row < P; ++row) jj(row, col) += weighted(row) * slope(col);
    }
  }

  struct Fit {
    double gain = 0, offset = 0, variance = 0;
    bool ok = false;
  };
  Fit fit() const {
    const double det = w * mm - m * m;
    if (w < 8 || det <= 1e-9 * w * mm) return {};
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

template <int P>
struct Problem {
  const StereoRig& rig;
  const PointSet& points;
  const PreparedFrame& frame;
  const RefineOptions& options;
  bool both_eyes;
  std::array<typename ChannelSums<P>::Fit, 6> fits = {};

  // One pass: point_of(i, point, by_parameter) gives a point in the left camera and its slope.
  template <class PointOf>
  bool accumulate(PointOf&& point_of, Matrix<double, P, P>& hessian, Matrix<double, P, 1>& slope) {
    std::array<ChannelSums<P>, 6> sums;
    const Eigen::Matrix3d right = rig.right_from_left.rotation.toRotationMatrix();
    for (int eye = both_eyes ? 0 : 1; eye < 2; ++eye) {
      const Intrinsics& camera = eye == 0 ? rig.left : rig.right;
      const EyePlanes& planes = eye == 0 ? frame.left() : frame.right();
      for (int k = 0; k < points.total_padded; ++k) {
        const auto i = static_cast<std::size_t>(k);
        if (std::isnan(points.x[i])) continue;
        Vector3d p;
        Matrix<double, 3, P> by;
        point_of(i, p, by);
        if (eye == 1) {
          p = right * p + rig.right_from_left.translation;
          by = right * by;
        }
        Projection at;
        if (!project(camera, p, at)) continue;
        const Matrix<double, 2, P> pixel_by = at.by_point * by;
        const double base = k < points.inside_padded ? 1.0 : options.outside_weight;
        Place place;
        if (!place.set(planes.width, planes.height, at.pixel)) continue;
        const float model[3] = {points.colour[i].y, points.colour[i].u, points.colour[i].v};
        for (std::size_t c = 0; c < 3; ++c) {
          const Sample s = place.sample(planes.smooth[c]);
          const std::size_t ce = static_cast<std::size_t>(3 * eye) + c;
          const auto m = static_cast<double>(model[c]);
          double weight = base;
          if (fits[ce].ok) {
            const double r = s.value - fits[ce].gain * m - fits[ce].offset;
            weight /= 1 + r * r / (6 * fits[ce].variance);  // Cauchy at 2.4 σ
          }
          sums[ce].add(weight, m, s.value, pixel_by.transpose() * s.gradient);
        }
      }
    }
    hessian.setZero();
    slope.setZero();
    int channels = 0;
    for (std::size_t ce = 0; ce < 6; ++ce) {
      fits[ce] = sums[ce].fit();
      if (!fits[ce].ok) continue;
      sums[ce].eliminate(fits[ce], hessian, slope);
      ++channels;
    }
    return channels > 0;
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

template <int P>
bool invert(const Matrix<double, P, P>& hessian, double factor, Matrix<double, P, P>& covariance) {
  const Eigen::LDLT<Matrix<double, P, P>> ldlt(hessian);
  if (ldlt.info() != Eigen::Success || ldlt.vectorD().minCoeff() <= 0) return false;
  covariance = factor * ldlt.solve(Matrix<double, P, P>::Identity());
  return covariance.allFinite();
}

Eigen::Matrix3d cross_matrix(const Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

Refinement refine_pose(const StereoRig& rig, const PointSet& points, const PreparedFrame& frame,
                       const Transform<LeftCamera, Target>& start, const RefineOptions& options) {
  Refinement out = {false, start, Matrix6d::Zero()};
  Problem<6> problem = {rig, points, frame, options, true, {}};
  Matrix6d hessian;
  Vector6d slope, step;
  // A first pass without weights fits gains and variances for the weights of the next.
  for (int k = 0; k <= options.iterations; ++k) {
    const Eigen::Matrix3d rotation = out.left_from_target.rotation.toRotationMatrix();
    const auto point_of = [&](std::size_t i, Vector3d& p, Matrix<double, 3, 6>& by) {
      const Vector3d arm = rotation.col(0) * static_cast<double>(points.x[i]) +
                           rotation.col(1) * static_cast<double>(points.y[i]);
      p = arm + out.left_from_target.translation;
      by.leftCols<3>().setIdentity();
      by.rightCols<3>() = -cross_matrix(arm);
    };
    if (!problem.accumulate(point_of, hessian, slope) || !solve<6>(hessian, slope, step)) {
      return out;
    }
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
    if (step.norm() < options.step_stop) break;
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

Refinement refine_plane(const StereoRig& rig, const PointSet& points, const PreparedFrame& frame,
                        const Transform<LeftCamera, Target>& start, const Vector3d& centre,
                        const RefineOptions& options) {
  Refinement out = {false, start, Matrix6d::Zero()};
  const Vector3d normal = start.rotation * Vector3d::UnitZ();
  Vector3d plane = normal / normal.dot(start.translation);
  Problem<3> problem = {rig, points, frame, options, false, {}};
  Eigen::Matrix3d hessian;
  Vector3d slope, step;
  for (int k = 0; k <= options.iterations; ++k) {
    const auto point_of = [&](std::size_t i, Vector3d& p, Eigen::Matrix3d& by) {
      const Vector3d ray(static_cast<double>(points.x[i]), static_cast<double>(points.y[i]), 1);
      const double inverse_depth = plane.dot(ray);
      p = ray / inverse_depth;
      by = -p * ray.transpose() / inverse_depth;
    };
    if (!problem.accumulate(point_of, hessian, slope) || !solve<3>(hessian, slope, step)) {
      return out;
    }
    if (k == options.iterations) break;
    const double change = std::abs(step.dot(centre)) / plane.dot(centre);
    step *= std::min(1.0, 0.03 / std::max(change, 1e-12));
    plane += step;
    if (plane.dot(centre) <= 0) return out;
    if (step.norm() * (1 / plane.dot(centre)) < options.step_stop) break;
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
