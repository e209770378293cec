#include "src/vision/relief.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace gannet::vision {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kPointsCompared = 48;   // a frame
constexpr int kPairsJoined = 120000;  // a frame, of points with possible neighbours
constexpr int kPasses = 7;            // frames that each point is compared in
constexpr double kReach = 0.25;       // depths on either side, as a share of √(area of S_in)
constexpr double kRadius = 4;         // of the neighbourhood, in spacings
constexpr float kMostCost = 600;      // grey levels², all channels: an outlier counts no more

// Pixels of a point at every depth, from three of them: the curve is nearly straight.
struct Track {
  Vector2d middle, slope, bend;
  Vector2d at(double t) const { return middle + t * (slope + t * bend); }  // t: -1 … 1
};

struct Sampler {
  const EyePlanes& eye;
  bool contains(const Vector2d& p) const {
    return p.x() >= 1 && p.y() >= 1 && p.x() < eye.width - 2 && p.y() < eye.height - 2;
  }
  double at(std::size_t channel, const Vector2d& p) const {
    const int u = static_cast<int>(p.x()), v = static_cast<int>(p.y());
    const double a = p.x() - u, b = p.y() - v;
    const std::uint8_t* const q = eye.smooth[channel] + v * eye.width + u;
    const double above = (1 - a) * q[0] + a * q[1];
    const double below = (1 - a) * q[eye.width] + a * q[eye.width + 1];
    return (1 - b) * above + b * below;
  }
};

// The right eye's image in the left eye's grey levels.
struct Match {
  double scale = 0, offset = 0;
  bool ok = false;
};

std::array<Match, 3> matches(const std::array<Refinement::Look, 6>& looks) {
  std::array<Match, 3> out;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto& left = looks[c];
    const auto& right = looks[3 + c];
    if (!left.ok || !right.ok) continue;
    const double scale = left.gain / right.gain;
    out[c] = {scale, 128 + left.offset - scale * (128 + right.offset), true};
  }
  return out;
}

}  // namespace

ReliefEstimator::ReliefEstimator(int max_points) {
  const auto n = static_cast<std::size_t>(max_points);
  cost_.reserve(n * kDepths);
  for (auto* values : {&frames_, &chosen_, &certainty_, &z_}) values->reserve(n);
}

void ReliefEstimator::reset(const PointSet& flat, double spacing_m, const Vector3d& eye_m) {
  const auto n = static_cast<std::size_t>(flat.inside);
  cost_.assign(n * kDepths, 0);
  for (auto* values : {&frames_, &chosen_, &certainty_, &z_}) values->assign(n, 0);
  const double size = spacing_m * std::sqrt(static_cast<double>(n));
  step_m_ = kReach * size / ((kDepths - 1) / 2);
  radius_m_ = kRadius * spacing_m;
  eye_m_ = eye_m;
  stage_ = Stage::kCompare;
  next_ = 0;
  passes_ = 0;
}

Vector3d ReliefEstimator::at_depth(const PointSet& flat, std::size_t k, double z) const {
  const Vector3d p(static_cast<double>(flat.x[k]), static_cast<double>(flat.y[k]), 0);
  return p + (p - eye_m_) * (z / -eye_m_.z());
}

void ReliefEstimator::see(const StereoRig& rig, const PointSet& flat, const PreparedFrame& frame,
                          const Refinement& seen) {
  const std::size_t n = z_.size();
  const auto slice = static_cast<std::size_t>(
      stage_ == Stage::kCompare ? kPointsCompared
                                : std::max(1, kPairsJoined / std::max(1, static_cast<int>(n))));
  const std::size_t end = std::min(n, next_ + slice);
  for (; next_ < end; ++next_) {
    if (stage_ == Stage::kCompare) compare(rig, flat, frame, seen, next_);
    if (stage_ == Stage::kChoose) choose(flat, next_);
    if (stage_ == Stage::kBlend) blend(flat, next_);
  }
  if (next_ < n || complete()) return;
  next_ = 0;
  if (stage_ == Stage::kCompare && ++passes_ < kPasses) return;
  stage_ = static_cast<Stage>(static_cast<int>(stage_) + 1);
}

void ReliefEstimator::compare(const StereoRig& rig, const PointSet& flat,
                              const PreparedFrame& frame, const Refinement& seen, std::size_t k) {
  Track tracks[2];
  const Sampler samplers[2] = {{frame.left()}, {frame.right()}};
  Vector2d ends[2][2], middle[2];
  for (const int third : {-1, 0, 1}) {
    const Vector3d p = seen.left_from_target(at_depth(flat, k, third * depth(kDepths - 1)));
    const auto left = rig.left.project(p), right = rig.right.project(rig.right_from_left(p));
    if (!left || !right || !samplers[0].contains(*left) || !samplers[1].contains(*right)) return;
    (third == 0 ? middle[0] : ends[0][third > 0]) = *left;
    (third == 0 ? middle[1] : ends[1][third > 0]) = *right;
  }
  for (const int eye : {0, 1}) {
    tracks[eye] = {middle[eye], (ends[eye][1] - ends[eye][0]) / 2,
                   (ends[eye][1] + ends[eye][0]) / 2 - middle[eye]};
  }
  const auto match = matches(seen.looks);
  for (int d = 0; d < kDepths; ++d) {
    const double t = depth(d) / depth(kDepths - 1);
    const Vector2d left = tracks[0].at(t), right = tracks[1].at(t);
    double cost = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      if (!match[c].ok) continue;
      const double apart =
          samplers[0].at(c, left) - (match[c].scale * samplers[1].at(c, right) + match[c].offset);
      cost += apart * apart;
    }
    cost_[k * kDepths + static_cast<std::size_t>(d)] +=
        std::min(static_cast<float>(cost), kMostCost);
  }
  frames_[k] += 1;
}

template <class Visit>
void ReliefEstimator::for_neighbours(const PointSet& flat, std::size_t k, Visit&& visit) const {
  const float radius2 = static_cast<float>(radius_m_ * radius_m_);
  for (std::size_t j = 0; j < z_.size(); ++j) {
    const float x = flat.x[j] - flat.x[k], y = flat.y[j] - flat.y[k];
    const float apart2 = x * x + y * y;
    if (apart2 <= radius2) visit(j, std::exp(-2 * apart2 / radius2));
  }
}

// The depth at which the neighbourhood looks most alike in both eyes, and how sharply.
void ReliefEstimator::choose(const PointSet& flat, std::size_t k) {
  std::array<float, kDepths> sum = {};
  for_neighbours(flat, k, [&](std::size_t j, float weight) {
    if (frames_[j] <= 0) return;
    for (std::size_t d = 0; d < kDepths; ++d)
      sum[d] += weight / frames_[j] * cost_[j * kDepths + d];
  });
  const auto best = std::min_element(sum.begin(), sum.end());
  certainty_[k] = 0;
  if (best == sum.begin() || best == sum.end() - 1) return;  // out of reach, or nothing seen
  const double sharpness = static_cast<double>(best[-1]) - 2 * static_cast<double>(best[0]) +
                           static_cast<double>(best[1]);
  if (sharpness <= 0) return;
  const double beside = (static_cast<double>(best[-1]) - static_cast<double>(best[1])) / 2;
  chosen_[k] =
      static_cast<float>(depth(static_cast<double>(best - sum.begin()) + beside / sharpness));
  certainty_[k] = static_cast<float>(sharpness);
}

void ReliefEstimator::blend(const PointSet& flat, std::size_t k) {
  float sum = 0, total = 0;
  for_neighbours(flat, k, [&](std::size_t j, float weight) {
    sum += weight * certainty_[j] * chosen_[j];
    total += weight * certainty_[j];
  });
  z_[k] = total > 0 ? sum / total : 0;
}

void ReliefEstimator::lay(const PointSet& flat, PointSet& solid) const {
  solid = flat;
  solid.z.assign(flat.x.size(), 0);
  for (std::size_t k = 0; k < z_.size(); ++k) {
    const Vector3d p = at_depth(flat, k, static_cast<double>(z_[k]));
    solid.x[k] = static_cast<float>(p.x());
    solid.y[k] = static_cast<float>(p.y());
    solid.z[k] = z_[k];
  }
}

}  // namespace gannet::vision
