#include "src/track/search_space.hpp"

#include <algorithm>
#include <cmath>

namespace gannet::track {
namespace {

// Sine and cosine for |a| <= π by their series about 0 of a/2 and the double-angle formulas:
// IEEE arithmetic only, error below 1e-13.
struct SineCosine {
  double s, c;
};
SineCosine sine_cosine(double a) {
  const double h = a / 2;
  const double h2 = h * h;
  double s = 0;
  double c = 0;
  for (int k = 10; k >= 1; --k) {
    s = -h2 / ((2.0 * k) * (2.0 * k + 1)) * (1 + s);
    c = -h2 / ((2.0 * k - 1) * (2.0 * k)) * (1 + c);
  }
  const double sh = h * (1 + s);
  const double ch = 1 + c;
  return {2 * sh * ch, 1 - 2 * sh * sh};
}

double across(double gene, double low, double high) { return low + gene * (high - low); }

float gene_of(double value, double low, double high) {
  if (!(high > low)) return 0.5f;
  return static_cast<float>(std::clamp((value - low) / (high - low), 0.0, 1.0));
}

}  // namespace

// Where an edge ray of a camera is at depth z of the left camera: linear in z.
SearchSpace::Range SearchSpace::field_of_view(const StereoRig& rig, int axis) {
  const auto left_from_right = rig.right_from_left.inverse();
  const auto edge = [&](const Intrinsics& camera, bool is_right, bool high, double& offset,
                        double& slope) {
    Eigen::Vector2d pixel(camera.cx, camera.cy);
    pixel(axis) = high ? (axis == 0 ? camera.width : camera.height) - 1 : 0;
    auto [origin, direction] = camera.line(pixel).value_or(Line{});
    if (is_right) {
      direction = left_from_right.rotation * direction;
      origin = left_from_right(origin);
    }
    slope = direction(axis) / direction.z();
    offset = origin(axis) - origin.z() * slope;
  };
  // The right camera's edge limits where it is the tighter one at 1 m; parallel rigs cross nowhere.
  Range range;
  double offset = 0, slope = 0;
  edge(rig.left, false, false, range.low_offset, range.low_slope);
  edge(rig.right, true, false, offset, slope);
  if (offset + slope > range.low(1)) range.low_offset = offset, range.low_slope = slope;
  edge(rig.left, false, true, range.high_offset, range.high_slope);
  edge(rig.right, true, true, offset, slope);
  if (offset + slope < range.high(1)) range.high_offset = offset, range.high_slope = slope;
  return range;
}

SearchSpace::SearchSpace(const StereoRig& rig, const SearchVolume& volume)
    : x_(field_of_view(rig, 0)),
      y_(field_of_view(rig, 1)),
      near_(1 / volume.z_min_m),
      far_(1 / volume.z_max_m),
      tilt_(volume.tilt_rad),
      roll_(volume.roll_rad) {
  const Eigen::Vector3d middle = rig.right_from_left.inverse().translation / 2;
  const auto narrow = [](Range& range, double centre, double half_width) {
    if (half_width > 0) range = {centre - half_width, 0, centre + half_width, 0};
  };
  narrow(x_, middle.x(), volume.half_width_x_m);
  narrow(y_, middle.y(), volume.half_width_y_m);
}

void SearchSpace::fix_ray(const Eigen::Vector3d& ray) {
  three_ = true;
  ray_ = ray;
}

vision::Hypothesis SearchSpace::decode(std::span<const float> genes) const {
  const auto g = [&](std::size_t i) { return static_cast<double>(genes[i]); };
  vision::Hypothesis q;
  const std::size_t depth = three_ ? 0 : 2;
  const double z = 1 / across(g(depth), near_, far_);
  const auto [sx, cx] = sine_cosine(across(g(depth + 1), -tilt_, tilt_));
  const auto [sy, cy] = sine_cosine(across(g(depth + 2), -tilt_, tilt_));
  if (three_) {
    q.translation = {ray_.x() * z, ray_.y() * z, z};
    q.rotation = {cy, sy * sx, sy * cx, 0, cx, -sx, -sy, cy * sx, cy * cx};
    return q;
  }
  const auto [sz, cz] = sine_cosine(across(g(5), -roll_, roll_));
  q.translation = {across(g(0), x_.low(z), x_.high(z)), across(g(1), y_.low(z), y_.high(z)), z};
  q.rotation = {cz * cy,
                cz * sy * sx - sz * cx,
                cz * sy * cx + sz * sx,
                sz * cy,
                sz * sy * sx + cz * cx,
                sz * sy * cx - cz * sx,
                -sy,
                cy * sx,
                cy * cx};
  return q;
}

// θx, θy, θz of R = Rz·Ry·Rx; with three genes the two tilts of the plane's normal.
Eigen::Vector3d SearchSpace::angles_of(const Eigen::Quaterniond& rotation) const {
  if (!three_) return rpy_from_quaternion(rotation);
  const Eigen::Vector3d n = rotation * Eigen::Vector3d::UnitZ();
  return {std::asin(std::clamp(-n.y(), -1.0, 1.0)), std::atan2(n.x(), n.z()), 0};
}

bool SearchSpace::contains(const Transform<LeftCamera, Target>& pose, const Slack& slack) const {
  constexpr double kRounding = 1e-6;  // metres and radians
  const Eigen::Vector3d t = pose.translation;
  const Eigen::Vector3d angles = angles_of(pose.rotation).cwiseAbs();
  const double length = kRounding + slack.depth_share * std::abs(t.z());
  const double angle = kRounding + slack.angle_rad;
  if (t.z() < 1 / near_ - length || t.z() > 1 / far_ + length) return false;
  if (angles.head<2>().maxCoeff() > tilt_ + angle) return false;
  if (three_) return true;
  return angles.z() <= roll_ + angle && t.x() >= x_.low(t.z()) - length &&
         t.x() <= x_.high(t.z()) + length && t.y() >= y_.low(t.z()) - length &&
         t.y() <= y_.high(t.z()) + length;
}

void SearchSpace::encode(const Transform<LeftCamera, Target>& pose, std::span<float> genes) const {
  const Eigen::Vector3d t = pose.translation;
  const double z = std::clamp(t.z(), 1 / near_, 1 / far_);
  const Eigen::Vector3d angles = angles_of(pose.rotation);
  const std::size_t depth = three_ ? 0 : 2;
  if (!three_) {
    genes[0] = gene_of(t.x(), x_.low(z), x_.high(z));
    genes[1] = gene_of(t.y(), y_.low(z), y_.high(z));
    genes[5] = gene_of(angles.z(), -roll_, roll_);
  }
  // near_ > far_: the gene counts from near to far.
  genes[depth] = static_cast<float>(std::clamp((near_ - 1 / z) / (near_ - far_), 0.0, 1.0));
  genes[depth + 1] = gene_of(angles.x(), -tilt_, tilt_);
  genes[depth + 2] = gene_of(angles.y(), -tilt_, tilt_);
}

}  // namespace gannet::track
