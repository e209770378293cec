#include "src/vision/hypothesis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gannet::vision {
namespace {

// Radius that the table must reach: a little more than the image's corners see, as far as the
// distortion is one-to-one. A lens that sees wide would otherwise spend the table on nothing.
double table_radius(const Intrinsics& camera) {
  double radius = 0;
  for (const double x : {0.0, (camera.width - 1) / 2.0, camera.width - 1.0}) {
    for (const double y : {0.0, (camera.height - 1) / 2.0, camera.height - 1.0}) {
      const Eigen::Vector3d ray = camera.ray({x, y});
      if (ray.allFinite()) radius = std::max(radius, ray.head<2>().norm() / ray.z());
    }
  }
  return std::min(1.05 * radius, camera.valid_radius());
}

// Radial factor (distorted radius over undistorted) and the range in which it is one-to-one.
LensTable make_lens(const Intrinsics& camera) {
  LensTable lens = {};
  const double radius = table_radius(camera);
  lens.r2_max = static_cast<float>(radius * radius);
  lens.scale = static_cast<float>(LensTable::kSteps / (radius * radius));
  Intrinsics radial = camera;
  if (camera.distortion == Distortion::kBrown) {
    lens.p1 = static_cast<float>(camera.coefficients[2]);
    lens.p2 = static_cast<float>(camera.coefficients[3]);
    radial.coefficients[2] = radial.coefficients[3] = 0;
  }
  for (int i = 0; i < LensTable::kSteps + 2; ++i) {
    const double r = std::sqrt(std::max(i, 1) / static_cast<double>(lens.scale));
    const double factor = radial.distort({r, 0}).x() / r;
    lens.factor[i] = i == 0 ? 1.0f : static_cast<float>(factor);
  }
  return lens;
}

}  // namespace

Transform<LeftCamera, Target> Hypothesis::pose() const {
  Eigen::Matrix3d r;
  r << rotation[0], rotation[1], rotation[2], rotation[3], rotation[4], rotation[5], rotation[6],
      rotation[7], rotation[8];
  return {canonical(Eigen::Quaterniond(r).normalized()),
          {translation[0], translation[1], translation[2]}};
}

Hypothesis Hypothesis::from(const Transform<LeftCamera, Target>& pose) {
  const Eigen::Matrix3d r = pose.rotation.toRotationMatrix();
  return {{r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)},
          {pose.translation.x(), pose.translation.y(), pose.translation.z()}};
}

CameraModel::CameraModel(const Intrinsics& intrinsics,
                         const Transform<RightCamera, LeftCamera>* from_left)
    : intrinsics_(intrinsics) {
  if (from_left != nullptr) {
    const Eigen::Matrix3d r = from_left->rotation.toRotationMatrix();
    for (int row = 0; row < 3; ++row) {
      for (int col = 0; col < 3; ++col) {
        rotation_[static_cast<std::size_t>(3 * row + col)] = r(row, col);
      }
      translation_[static_cast<std::size_t>(row)] = from_left->translation(row);
    }
  }
  if (has_port()) port_ = PortOptics(intrinsics);
  if (!has_lens()) return;
  lens_[0] = make_lens(intrinsics);
  double scale = 1;
  for (LensTable& lens : lens_) {
    lens = lens_[0];
    lens.fx = static_cast<float>(intrinsics.fx * scale);
    lens.fy = static_cast<float>(intrinsics.fy * scale);
    lens.cx = static_cast<float>((intrinsics.cx + 0.5) * scale - 0.5);
    lens.cy = static_cast<float>((intrinsics.cy + 0.5) * scale - 0.5);
    scale /= 2;
  }
}

namespace {

using Row = std::array<double, 3>;  // a linear form of (x, y, 1)

Row row_of(const std::array<double, 9>& g, std::size_t k) {
  return {g[3 * k], g[3 * k + 1], g[3 * k + 2]};
}
double at(const Row& r, double x, double y) { return (r[0] * x + r[1] * y) + r[2]; }

// Adds c · a · b, in the order of PlaneView::e.
void add_product(double c, const Row& a, const Row& b, std::array<double, 6>& e) {
  e[0] += c * (a[0] * b[0]);
  e[1] += c * (a[0] * b[1] + a[1] * b[0]);
  e[2] += c * (a[0] * b[2] + a[2] * b[0]);
  e[3] += c * (a[1] * b[1]);
  e[4] += c * (a[1] * b[2] + a[2] * b[1]);
  e[5] += c * (a[2] * b[2]);
}

}  // namespace

// What points are seen along in air, p + (v − w) · axis: v² is taken to its first order in q and λ
// about the middle of the points, and so is a quadratic form; the rest goes into g.
void CameraModel::add_port(const Plane& plane, PlaneView& view, std::array<double, 9>& g) const {
  const auto& axis = port_.axis();
  Row w = {};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t m = 0; m < 3; ++m) {
      g[3 * k + m] -= port_.pupil()[k] * plane.scale[m];
      w[m] += axis[k] * g[3 * k + m];
    }
  }
  const auto& [x, y, z] = plane.middle;
  const double scale = at(plane.scale, x, y) * z;
  const double depth = at(w, x, y) * z;
  double length2 = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double p = at(row_of(g, k), x, y) * z;
    length2 += p * p;
  }
  const PortOptics::Squared v = port_.squared(length2 / (depth * depth) - 1, scale / depth);
  std::array<double, 6> e = {};
  for (std::size_t k = 0; k < 3; ++k) add_product(v.by_q, row_of(g, k), row_of(g, k), e);
  add_product(v.offset - v.by_q, w, w, e);
  add_product(v.by_lambda, w, plane.scale, e);
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t m = 0; m < 3; ++m) g[3 * k + m] -= axis[k] * w[m];
  // Beyond the glass even where the plane is nearest.
  Row beyond;
  for (std::size_t m = 0; m < 3; ++m) beyond[m] = w[m] - port_.nearest_m() * plane.scale[m];
  const double slope = std::sqrt(beyond[0] * beyond[0] + beyond[1] * beyond[1]);
  if (!(beyond[2] > static_cast<double>(plane.reach) * slope))
    e[5] = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < 6; ++k) view.e[k] = static_cast<float>(e[k]);
}

PlaneView CameraModel::finish(const Plane& plane, int level, int width, int height,
                              int guard) const {
  PlaneView view = {{}, width, height, width, guard};
  std::array<double, 9> g = plane.g;
  if (has_port()) add_port(plane, view, g);
  const double scale = 1.0 / (1 << level);
  const double fx = intrinsics_.fx * scale;
  const double fy = intrinsics_.fy * scale;
  const double cx = (intrinsics_.cx + 0.5) * scale - 0.5;
  const double cy = (intrinsics_.cy + 0.5) * scale - 0.5;
  const auto pixels = [&](double x, double y, double z, float* to, std::size_t step) {
    to[0] = static_cast<float>(has_lens() ? x : fx * x + cx * z);
    to[step] = static_cast<float>(has_lens() ? y : fy * y + cy * z);
    to[2 * step] = static_cast<float>(z);
  };
  for (std::size_t k = 0; k < 3; ++k) pixels(g[k], g[3 + k], g[6 + k], view.h + k, 3);
  if (has_port()) pixels(port_.axis()[0], port_.axis()[1], port_.axis()[2], view.port, 1);
  return view;
}

PlaneView CameraModel::view(const Hypothesis& q, float reach, int level, int width, int height,
                            int guard) const {
  // Columns: the target's x and y axes and its origin, in this camera.
  Plane plane;
  plane.reach = reach;
  plane.middle = {0, 0, 1};
  std::array<double, 9>& g = plane.g;
  const auto& r = rotation_;
  for (std::size_t row = 0; row < 3; ++row) {
    const std::size_t k = 3 * row;
    for (std::size_t col = 0; col < 2; ++col) {
      g[k + col] = (r[k] * q.rotation[col] + r[k + 1] * q.rotation[3 + col]) +
                   r[k + 2] * q.rotation[6 + col];
    }
    g[k + 2] =
        ((r[k] * q.translation[0] + r[k + 1] * q.translation[1]) + r[k + 2] * q.translation[2]) +
        translation_[row];
  }
  return finish(plane, level, width, height, guard);
}

PlaneView CameraModel::ray_view(const Hypothesis& q, float reach, int level, int width, int height,
                                int guard) const {
  // A ray m meets the plane n·p = d at m·d/(n·m); in this camera, up to scale: (R + t nᵀ/d) m.
  const double n[3] = {q.rotation[2], q.rotation[5], q.rotation[8]};
  const double d = (n[0] * q.translation[0] + n[1] * q.translation[1]) + n[2] * q.translation[2];
  Plane plane;
  plane.reach = reach;
  plane.middle = {q.translation[0] / q.translation[2], q.translation[1] / q.translation[2],
                  q.translation[2]};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t col = 0; col < 3; ++col) {
      plane.g[3 * row + col] = rotation_[3 * row + col] + translation_[row] * n[col] / d;
    }
    plane.scale[row] = n[row] / d;
  }
  return finish(plane, level, width, height, guard);
}

}  // namespace gannet::vision
