#include "src/vision/symmetry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace gannet::vision {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;

std::size_t cell(const PhotoPatch& p, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(p.width) +
         static_cast<std::size_t>(x);
}

Vector3d shown(const PhotoPatch& p, const Vector2d& at_m) {
  Vector3d colour;
  if (sample_photo(p, at_m, colour)) return colour;
  return Vector3d(static_cast<double>(p.background.y), static_cast<double>(p.background.u),
                  static_cast<double>(p.background.v));
}

Vector2d place_of(const PhotoPatch& p, int x, int y) {
  return {(x - p.centre_px.x()) * p.distance_m / p.fx, (y - p.centre_px.y()) * p.distance_m / p.fy};
}

// From the target's origin to its farthest pixel.
double radius_of(const PhotoPatch& p) {
  double radius = 0;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x)
      if (p.mask[cell(p, x, y)] != 0) radius = std::max(radius, place_of(p, x, y).norm());
  return radius;
}

}  // namespace

bool sample_photo(const PhotoPatch& p, const Vector2d& at_m, Vector3d& colour) {
  const double u = p.centre_px.x() + at_m.x() * p.fx / p.distance_m;
  const double v = p.centre_px.y() + at_m.y() * p.fy / p.distance_m;
  if (!(u >= 0) || !(v >= 0) || !(u < p.width - 1) || !(v < p.height - 1)) return false;
  const int x = static_cast<int>(u), y = static_cast<int>(v);
  colour.setZero();
  for (int i = 0; i < 4; ++i) {
    const std::size_t at = cell(p, x + i % 2, y + i / 2);
    if (p.mask[at] == 0) return false;
    const double weight = (i % 2 == 0 ? 1 - (u - x) : u - x) * (i / 2 == 0 ? 1 - (v - y) : v - y);
    for (int c = 0; c < 3; ++c) colour[c] += weight * p.yuv[3 * at + static_cast<std::size_t>(c)];
  }
  return true;
}

double likeness_when_rolled(const PhotoPatch& patch, double angle_rad) {
  constexpr int kHalf = 24;  // grid steps from the middle to the border
  const double radius = radius_of(patch);
  const Eigen::Rotation2Dd roll(angle_rad);
  Vector3d a_sum = Vector3d::Zero(), b_sum = a_sum, aa = a_sum, bb = a_sum, ab = a_sum;
  int n = 0;
  for (int y = -kHalf; y <= kHalf; ++y) {
    for (int x = -kHalf; x <= kHalf; ++x) {
      const Vector2d at = Vector2d(x, y) * (radius / kHalf);
      if (at.norm() > radius) continue;
      const Vector3d a = shown(patch, at), b = shown(patch, roll * at);
      a_sum += a, b_sum += b;
      aa += a.cwiseProduct(a), bb += b.cwiseProduct(b), ab += a.cwiseProduct(b);
      ++n;
    }
  }
  const double variances =
      (aa - a_sum.cwiseProduct(a_sum) / n).sum() * (bb - b_sum.cwiseProduct(b_sum) / n).sum();
  if (!(variances > 1e-6)) return 0;
  return (ab - a_sum.cwiseProduct(b_sum) / n).sum() / std::sqrt(variances);
}

Symmetry symmetry_of(const PhotoPatch& patch) {
  constexpr int kStep = 5, kFirst = 30, kLast = 180, kCount = (kLast - kFirst) / kStep + 3;
  constexpr double kAlike = 0.9, kEqual = 1e-9;
  std::array<double, kCount> likeness;  // one more to either side
  for (int i = 0; i < kCount; ++i)
    likeness[static_cast<std::size_t>(i)] =
        likeness_when_rolled(patch, (kFirst + (i - 1) * kStep) * kDegree);
  Symmetry out;
  out.any_roll = *std::min_element(likeness.begin(), likeness.end()) > kAlike;
  for (std::size_t i = 1; i + 1 < likeness.size() && !out.any_roll; ++i) {
    const double here = likeness[i];
    if (here > kAlike && here >= likeness[i - 1] - kEqual && here >= likeness[i + 1] - kEqual)
      out.rolls.push_back((kFirst + (static_cast<int>(i) - 1) * kStep) * kDegree);
  }
  return out;
}

Transform<LeftCamera, Target> nearest_equivalent(const Symmetry& symmetry,
                                                 const Transform<LeftCamera, Target>& pose,
                                                 const Eigen::Quaterniond& attitude) {
  const auto rolled = [&](double by) {
    return Eigen::Quaterniond(pose.rotation * Eigen::AngleAxisd(by, Vector3d::UnitZ()));
  };
  Transform<LeftCamera, Target> out = pose;
  if (symmetry.any_roll) {
    const Eigen::Quaterniond turn = pose.rotation.conjugate() * attitude;
    out.rotation = rolled(2 * std::atan2(turn.z(), turn.w()));
    return out;
  }
  double nearest = pose.rotation.angularDistance(attitude);
  for (const double roll : symmetry.rolls) {
    for (const double by : {roll, -roll}) {
      const double away = rolled(by).angularDistance(attitude);
      if (away >= nearest) continue;
      nearest = away;
      out.rotation = rolled(by);
    }
  }
  return out;
}

}  // namespace gannet::vision
