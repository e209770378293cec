#include "src/vision/reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "src/vision/hue_value.hpp"
#include "src/vision/projection_fitness.hpp"

namespace gannet::vision::reference {
namespace {

template <class Visit>
void for_each_point(const PointSet& set, Visit&& visit) {
  for (int k = 0; k < set.total_padded; ++k) {
    const auto i = static_cast<std::size_t>(k);
    if (!std::isnan(set.x[i])) visit(i, k < set.inside_padded);
  }
}

std::size_t cell(const EyePlanes& eye, const Eigen::Vector2i& pixel) {
  return static_cast<std::size_t>(pixel.y() * eye.width + pixel.x());
}

struct Moments {
  double n = 0, i = 0, ii = 0, m = 0, mm = 0, im = 0;
  void add(double image, double model) {
    n += 1;
    i += image;
    ii += image * image;
    m += model;
    mm += model * model;
    im += image * model;
  }
  double var_model() const { return mm / n - m / n * m / n; }
  double correlation(double floor) const {
    const double var_image = ii / n - i / n * i / n;
    return (im / n - i / n * m / n) /
           std::sqrt((var_image + floor * floor) * (var_model() + floor * floor));
  }
};

double mean_correlation(const std::array<Moments, 3>& channels, const CorrelationOptions& options) {
  double sum = 0;
  double weights = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double weight = static_cast<double>(c == 0 ? options.weight_y : options.weight_uv);
    const double floor = static_cast<double>(c == 0 ? options.floor_y : options.floor_uv);
    const double var = channels[c].var_model();
    const double w = var / (var + weight * weight);
    sum += w * channels[c].correlation(floor);
    weights += w;
  }
  return weights > 0 ? sum / weights : 0;
}

}  // namespace

std::optional<Eigen::Vector2i> pixel_of(const StereoRig& rig, bool left_eye,
                                        const Transform<LeftCamera, Target>& pose, double x,
                                        double y, bool unscaled) {
  Eigen::Vector3d p;
  if (unscaled) {
    const Eigen::Vector3d n = pose.rotation * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d ray(x, y, 1);
    p = ray * (n.dot(pose.translation) / n.dot(ray));
  } else {
    p = pose({x, y, 0});
  }
  const auto pixel = left_eye ? rig.left.project(p) : rig.right.project(rig.right_from_left(p));
  if (!pixel) return std::nullopt;
  const Intrinsics& camera = left_eye ? rig.left : rig.right;
  const Eigen::Vector2i whole(static_cast<int>(std::floor(pixel->x() + 0.5)),
                              static_cast<int>(std::floor(pixel->y() + 0.5)));
  if (whole.x() < 0 || whole.y() < 0 || whole.x() >= camera.width || whole.y() >= camera.height) {
    return std::nullopt;
  }
  return whole;
}

double photo_model(const StereoRig& rig, const TargetPoints& target, const PreparedFrame& frame,
                   const Transform<LeftCamera, Target>& pose, VoteRule rule) {
  const PointSet& set = target.level[0];
  double sum = 0;
  for (const bool left : {true, false}) {
    const EyePlanes& eye = left ? frame.left() : frame.right();
    for_each_point(set, [&](std::size_t i, bool inside) {
      const auto pixel = pixel_of(rig, left, pose, static_cast<double>(set.x[i]),
                                  static_cast<double>(set.y[i]), false);
      if (!pixel) return;
      const int seen = eye.hue_value[cell(eye, *pixel)] & 0xFF;
      if (!inside) {
        sum += hue_distance(seen, target.background_hue) <= kHueNear20 ? 0.1 : -0.5;
      } else if (hue_distance(seen, set.hue[i]) <= kHueNear30) {
        sum += 2;
      } else if (rule == VoteRule::kP001 && hue_distance(seen, set.hue[i]) >= kHueFar50) {
        sum -= 1;
      } else if (hue_distance(set.hue[i], target.background_hue) <= kHueNear30) {
        sum -= 0.005;
      }
    });
  }
  return sum / (2.0 * set.points());
}

double projection(const StereoRig& rig, const TargetPoints& target, const PreparedFrame& frame,
                  const Transform<LeftCamera, Target>& pose) {
  const PointSet& set = target.level[0];
  const EyePlanes& eye = frame.right();
  double hue = 0;
  double value = 0;
  for_each_point(set, [&](std::size_t i, bool inside) {
    const auto pixel = pixel_of(rig, false, pose, static_cast<double>(set.x[i]),
                                static_cast<double>(set.y[i]), true);
    if (!pixel) return;
    const int seen = eye.hue_value[cell(eye, *pixel)];
    const int own = set.hue_value[i];
    const double good = inside ? 2 : 0.1;
    hue += hue_distance(seen & 0xFF, own & 0xFF) <= kHueNear20 ? good : -1;
    value += std::abs((seen >> 8) - (own >> 8)) <= kValueNear ? good : -1;
  });
  const double whole = 2.0 * set.inside + 0.1 * set.outside;
  const double f_h = std::max(0.0, hue / whole);
  const double f_b = std::max(0.0, value / whole);
  return f_h + f_b - f_h * f_b;
}

double correlation(const StereoRig& rig, const TargetPoints& target, const PreparedFrame& frame,
                   const Transform<LeftCamera, Target>& pose, const CorrelationOptions& options) {
  const PointSet& set = target.level[0];
  double total = 0;
  for (const bool left : {true, false}) {
    if (left && target.unscaled) continue;
    const EyePlanes& eye = left ? frame.left() : frame.right();
    std::array<Moments, 3> whole, inner;
    for_each_point(set, [&](std::size_t i, bool inside) {
      const auto pixel = pixel_of(rig, left, pose, static_cast<double>(set.x[i]),
                                  static_cast<double>(set.y[i]), target.unscaled);
      if (!pixel) return;
      const float model[3] = {set.colour[i].y, set.colour[i].u, set.colour[i].v};
      for (std::size_t c = 0; c < 3; ++c) {
        const double seen = eye.smooth[c][cell(eye, *pixel)];
        whole[c].add(seen, static_cast<double>(model[c]));
        if (inside) inner[c].add(seen, static_cast<double>(model[c]));
      }
    });
    const double share = whole[0].n / set.points();
    if (share < static_cast<double>(options.least_share)) {
      total += share - 1;
      continue;
    }
    const double a = static_cast<double>(options.inside_share);
    total += ((1 - a) * mean_correlation(whole, options) + a * mean_correlation(inner, options)) *
             std::min(1.0, share / static_cast<double>(options.full_share));
  }
  return target.unscaled ? total : total / 2;
}

}  // namespace gannet::vision::reference
