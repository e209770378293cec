#include "src/core/stereo_rig.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace gannet {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// No lens that keeps its points in front of the camera images rays farther out than 84°.
constexpr double kLargestRadius = 10;

double polynomial(std::span<const double> c, double t) {
  double value = 0;
  for (std::size_t i = c.size(); i-- > 0;) value = value * t + c[i];
  return value;
}

double bisect(std::span<const double> c, double low, double high) {
  const bool rising = polynomial(c, low) < 0;
  for (int i = 0; i < 100 && low < high; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    ((polynomial(c, middle) < 0) == rising ? low : high) = middle;
  }
  return low;
}

// The roots of the polynomial in (0, end), in order; returns how many. Between neighbouring roots
// of its derivative it is monotone, so that none can hide: a scan with steps would miss close
// pairs.
int roots_between(std::span<const double> c, double end, std::span<double> roots) {
  if (c.size() < 2) return 0;
  std::array<double, 4> slope{};
  for (std::size_t i = 1; i < c.size(); ++i) slope[i - 1] = static_cast<double>(i) * c[i];
  std::array<double, 6> edges{};
  const std::span<double> turns(edges.data() + 1, 4);
  const int turn_count =
      roots_between(std::span<const double>(slope.data(), c.size() - 1), end, turns);
  edges[static_cast<std::size_t>(turn_count) + 1] = end;
  int count = 0;
  for (int i = 0; i <= turn_count; ++i) {
    const double low = edges[static_cast<std::size_t>(i)];
    const double high = edges[static_cast<std::size_t>(i) + 1];
    const double a = polynomial(c, low);
    const double b = polynomial(c, high);
    if ((a < 0) != (b < 0)) roots[static_cast<std::size_t>(count++)] = bisect(c, low, high);
  }
  return count;
}

// How the radius (brown) or the angle (fisheye) is scaled: 1 + c₁t + c₂t² …, t its square.
std::array<double, 5> scale_polynomial(const Intrinsics& camera) {
  const auto& k = camera.coefficients;
  switch (camera.distortion) {
    case Distortion::kBrown:
      return {1, k[0], k[1], k[4], 0};
    case Distortion::kFisheye:
      return {1, k[0], k[1], k[2], k[3]};
    case Distortion::kNone:
      break;
  }
  return {1, 0, 0, 0, 0};
}

// d(s · scale(s²))/ds as a polynomial of t = s².
std::array<double, 5> slope_polynomial(const std::array<double, 5>& scale) {
  std::array<double, 5> slope = scale;
  for (std::size_t i = 0; i < slope.size(); ++i) slope[i] *= static_cast<double>(2 * i + 1);
  return slope;
}

// Whether the mapping surely grows up to t, by the sum of all that could pull it down.
bool surely_grows(const std::array<double, 5>& slope, double t) {
  double pull = 0;
  for (std::size_t i = slope.size(); i-- > 1;) pull = (pull + std::abs(slope[i])) * t;
  return pull < 1;
}

// The s in [0, largest] with s · scale(s²) = wanted; largest where it is out of reach.
double invert_scale(const std::array<double, 5>& scale, double wanted, double largest) {
  if (largest * polynomial(scale, largest * largest) <= wanted) return largest;
  double low = 0;
  double high = largest;
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    (middle * polynomial(scale, middle * middle) < wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Matrix2d brown_jacobian(const std::array<double, 5>& k, const Vector2d& n) {
  const double x = n.x();
  const double y = n.y();
  const double t = x * x + y * y;
  const double scale = 1 + t * (k[0] + t * (k[1] + t * k[4]));
  const double slope = 2 * (k[0] + t * (2 * k[1] + t * 3 * k[4]));  // d scale / d(x²+y²) · 2
  Matrix2d j;
  j << scale + slope * x * x + 2 * k[2] * y + 6 * k[3] * x,
      slope * x * y + 2 * k[2] * x + 2 * k[3] * y,  //
      slope * x * y + 2 * k[3] * y + 2 * k[2] * x,
      scale + slope * y * y + 6 * k[2] * y + 2 * k[3] * x;
  return j;
}

}  // namespace

Vector2d Intrinsics::distort(const Vector2d& n) const {
  const auto& k = coefficients;
  const double t = n.squaredNorm();
  switch (distortion) {
    case Distortion::kNone:
      return n;
    case Distortion::kBrown: {
      const double scale = 1 + t * (k[0] + t * (k[1] + t * k[4]));
      const double x = n.x();
      const double y = n.y();
      return {x * scale + 2 * k[2] * x * y + k[3] * (t + 2 * x * x),
              y * scale + k[2] * (t + 2 * y * y) + 2 * k[3] * x * y};
    }
    case Distortion::kFisheye: {
      const double r = std::sqrt(t);
      if (r < 1e-9) return n;
      const double angle = std::atan(r);
      const std::array<double, 5> scale = {1, k[0], k[1], k[2], k[3]};
      return n * (angle * polynomial(scale, angle * angle) / r);
    }
  }
  return n;
}

Vector2d Intrinsics::magnification() const {
  const double by_port = port ? port->water_index / port->air_index : 1;
  return {fx * by_port, fy * by_port};
}

Vector3d Intrinsics::pupil() const {
  return port ? Vector3d(port->pupil_m() * port->normal) : Vector3d::Zero();
}

double Intrinsics::valid_radius() const {
  if (distortion == Distortion::kNone) return std::numeric_limits<double>::infinity();
  const bool fisheye = distortion == Distortion::kFisheye;
  const double s_end = fisheye ? std::atan(kLargestRadius) : kLargestRadius;
  const std::array<double, 5> slope = slope_polynomial(scale_polynomial(*this));
  std::array<double, 5> roots{};
  const int count = roots_between(slope, s_end * s_end, roots);
  const double s = count > 0 ? std::sqrt(roots[0]) : s_end;
  return fisheye ? std::tan(s) : s;
}

std::optional<Vector2d> Intrinsics::project(const Vector3d& point) const {
  if (!port) return project_ray(point);
  const std::optional<Vector3d> in_air = port->air_ray(point);
  return in_air ? project_ray(*in_air) : std::nullopt;
}

std::optional<Line> Intrinsics::line(const Vector2d& pixel) const {
  if (!port) return Line{Vector3d::Zero(), ray(pixel)};
  return port->line(ray(pixel));
}

std::optional<Vector2d> Intrinsics::project_ray(const Vector3d& direction) const {
  if (!(direction.z() > 0)) return std::nullopt;
  const Vector2d n = direction.head<2>() / direction.z();
  if (distortion != Distortion::kNone) {
    const double r = n.norm();
    const double s = distortion == Distortion::kFisheye ? std::atan(r) : r;
    // Almost every point passes the cheap question; only the others need the exact radius.
    if (!(surely_grows(slope_polynomial(scale_polynomial(*this)), s * s) && r <= kLargestRadius) &&
        !(r <= valid_radius())) {
      return std::nullopt;
    }
  }
  const Vector2d d = distort(n);
  return Vector2d(fx * d.x() + cx, fy * d.y() + cy);
}

Vector3d Intrinsics::ray(const Vector2d& pixel) const {
  const Vector2d d((pixel.x() - cx) / fx, (pixel.y() - cy) / fy);
  const double distorted = d.norm();
  if (distortion == Distortion::kNone || distorted < 1e-12) return {d.x(), d.y(), 1};
  const bool fisheye = distortion == Distortion::kFisheye;
  const double largest = fisheye ? std::atan(valid_radius()) : valid_radius();
  const double s = invert_scale(scale_polynomial(*this), distorted, largest);
  Vector2d n = d * ((fisheye ? std::tan(s) : s) / distorted);
  if (!fisheye) {
    // The radial part is undone; Newton brings in the tangential one. A singular step stops it.
    for (int i = 0; i < 20; ++i) {
      const Matrix2d j = brown_jacobian(coefficients, n);
      if (std::abs(j.determinant()) < 1e-9) break;
      const Vector2d step = j.inverse() * (d - distort(n));
      n += step;
      if (step.norm() < 1e-14) break;
    }
  }
  return {n.x(), n.y(), 1};
}

namespace {

using Problems = std::vector<RigProblem>;

void check_camera(const std::string& name, const Intrinsics& camera, Problems& problems) {
  const auto refuse = [&](const char* key, const std::string& text) {
    problems.push_back({name + "." + key, text});
  };
  if (camera.width < 16 || camera.width > 16384) refuse("width", "is outside [16, 16384] pixels");
  if (camera.height < 16 || camera.height > 16384)
    refuse("height", "is outside [16, 16384] pixels");
  if (!(camera.fx > 0) || !std::isfinite(camera.fx)) refuse("fx", "is not a positive focal length");
  if (!(camera.fy > 0) || !std::isfinite(camera.fy)) refuse("fy", "is not a positive focal length");
  if (!std::isfinite(camera.cx)) refuse("cx", "is not a number");
  if (!std::isfinite(camera.cy)) refuse("cy", "is not a number");
  if (!problems.empty()) return;  // the next questions need the answers above
  if (camera.cx < -camera.width || camera.cx > 2 * camera.width)
    refuse("cx", "is farther from the image than the image is wide");
  if (camera.cy < -camera.height || camera.cy > 2 * camera.height)
    refuse("cy", "is farther from the image than the image is high");
  for (const double k : camera.coefficients) {
    if (std::isfinite(k)) continue;
    refuse("coefficients", "has one that is not a number");
    return;
  }
  // The middle of the image must be well inside: a wrong order or sign folds it at once. Corners
  // may lie beyond, as they do with real fisheyes.
  const double half = 0.5 * std::min(camera.width / camera.fx, camera.height / camera.fy);
  const double reach = camera.distort({camera.valid_radius(), 0}).norm();
  if (camera.distortion != Distortion::kNone && reach < 0.5 * half)
    refuse("coefficients", "fold the image over near its middle; are order and signs right?");
}

void check_port(const std::string& name, const Intrinsics& camera, Problems& problems) {
  const FlatPort& port = *camera.port;
  const auto refuse = [&](const char* key, const std::string& text) {
    problems.push_back({name + ".port." + key, text});
  };
  const std::size_t before = problems.size();
  // Not norm − 1 > tolerance: a NaN must not pass.
  if (!(std::abs(port.normal.norm() - 1) < 1e-6)) refuse("normal", "is not a unit vector");
  if (!(port.normal.z() > 0.5)) refuse("normal", "is more than 60 degrees off the camera's axis");
  if (!(port.distance_m >= 0 && port.distance_m <= 1)) refuse("distance_m", "is outside [0, 1] m");
  if (!(port.thickness_m >= 0 && port.thickness_m <= 0.2))
    refuse("thickness_m", "is outside [0, 0.2] m");
  const auto check_index = [&](const char* key, double index) {
    if (!(index >= 1 && index <= 2.5)) refuse(key, "is no index of refraction in [1, 2.5]");
  };
  check_index("air_index", port.air_index);
  check_index("glass_index", port.glass_index);
  check_index("water_index", port.water_index);
  if (problems.size() > before) return;  // the next question needs the answers above
  // Angles grow towards the corners: where light comes to them, it comes to all pixels.
  for (const double u : {0.0, camera.width - 1.0}) {
    for (const double v : {0.0, camera.height - 1.0}) {
      if (camera.line({u, v})) continue;
      return refuse("normal", "lets no light come to a corner of the image");
    }
  }
}

void check_rotation(const std::string& key, const Eigen::Quaterniond& rotation,
                    Problems& problems) {
  // Not fabs(norm − 1) > tolerance: a NaN must not pass.
  if (!(std::abs(rotation.norm() - 1) < 1e-6)) problems.push_back({key, "is not a rotation"});
}

}  // namespace

std::vector<RigProblem> problems_of(const StereoRig& rig) {
  Problems problems;
  Problems right;
  check_camera("left", rig.left, problems);
  check_camera("right", rig.right, right);
  problems.insert(problems.end(), right.begin(), right.end());
  for (const auto& [name, camera] : {std::pair("left", &rig.left), std::pair("right", &rig.right)})
    if (camera->port && problems.empty()) check_port(name, *camera, problems);
  check_rotation("right_from_left.rotation", rig.right_from_left.rotation, problems);
  check_rotation("hand_from_left.rotation", rig.hand_from_left.rotation, problems);
  if (rig.body_from_hand)
    check_rotation("body_from_hand.rotation", rig.body_from_hand->rotation, problems);
  if (!(rig.baseline_m() >= 1e-4 && rig.baseline_m() <= 100))
    problems.push_back({"right_from_left.translation_m",
                        "gives a baseline outside [0.0001, 100] m; two cameras stand apart"});
  return problems;
}

Result<void> check(const StereoRig& rig) {
  std::string text;
  for (const RigProblem& problem : problems_of(rig))
    text += (text.empty() ? "" : "\n") + problem.key + " " + problem.text;
  if (text.empty()) return {};
  return Error{"stereo rig: " + text};
}

}  // namespace gannet
