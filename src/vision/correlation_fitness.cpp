#include "src/vision/correlation_fitness.hpp"

#include <algorithm>
#include <cmath>

namespace gannet::vision {

CorrelationFitness::CorrelationFitness(const StereoRig& rig, const Kernels& kernels,
                                       const CorrelationOptions& options)
    : left_(rig.left, nullptr),
      right_(rig.right, &rig.right_from_left),
      kernels_(kernels),
      options_(options) {}

void CorrelationFitness::score(const TargetPoints& target, const PreparedFrame& frame, int level,
                               std::span<const Hypothesis> hypotheses, std::span<float> scores,
                               Scratch& scratch) const {
  const auto l = static_cast<std::size_t>(level);
  const PointSet& set = target.level[l];
  const PackedPlane& left = frame.left().packed[l];
  const PackedPlane& right = frame.right().packed[l];
  for (std::size_t k = 0; k < hypotheses.size(); ++k) {
    const Hypothesis& q = hypotheses[k];
    if (target.unscaled) {
      const PlaneView view =
          right_.ray_view(q, set.reach, level, right.width, right.height, right.guard);
      scores[k] = static_cast<float>(eye_score(set, right_, frame.right(), level, view, scratch));
      continue;
    }
    const double a =
        eye_score(set, left_, frame.left(), level,
                  left_.view(q, set.reach, level, left.width, left.height, left.guard), scratch);
    const double b = eye_score(
        set, right_, frame.right(), level,
        right_.view(q, set.reach, level, right.width, right.height, right.guard), scratch);
    scores[k] = static_cast<float>((a + b) / 2);
  }
}

float CorrelationFitness::weaker_eye(const TargetPoints& target, const PreparedFrame& frame,
                                     const Hypothesis& q, Scratch& scratch) const {
  const PointSet& set = target.level[0];
  const EyePlanes& eye = frame.right();
  const PackedPlane& plane = eye.packed[0];
  if (target.unscaled) {
    const PlaneView view = right_.ray_view(q, set.reach, 0, plane.width, plane.height, plane.guard);
    return static_cast<float>(eye_score(set, right_, eye, 0, view, scratch));
  }
  const double left =
      eye_score(set, left_, frame.left(), 0,
                left_.view(q, set.reach, 0, plane.width, plane.height, plane.guard), scratch);
  const double right =
      eye_score(set, right_, eye, 0,
                right_.view(q, set.reach, 0, plane.width, plane.height, plane.guard), scratch);
  return static_cast<float>(std::min(left, right));
}

namespace {

CorrelationSums operator+(const CorrelationSums& a, const CorrelationSums& b) {
  CorrelationSums sum;
  for (int c = 0; c < 3; ++c) {
    sum.i[c] = a.i[c] + b.i[c];
    sum.ii[c] = a.ii[c] + b.ii[c];
    sum.im[c] = a.im[c] + b.im[c];
    sum.m[c] = a.m[c] + b.m[c];
    sum.mm[c] = a.mm[c] + b.mm[c];
  }
  return sum;
}

}  // namespace

// Mean of the channels' correlations over n points, weighted by the model's contrast in them.
double CorrelationFitness::mean_correlation(const CorrelationSums& s, int n, const PointSet& set,
                                            const EyePlanes& eye) const {
  double sum = 0;
  double weights = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    // n² times the covariance and the variances, exact.
    const auto cov = static_cast<double>(std::int64_t{n} * s.im[c] - std::int64_t{s.i[c]} * s.m[c]);
    const auto var_i =
        static_cast<double>(std::int64_t{n} * s.ii[c] - std::int64_t{s.i[c]} * s.i[c]);
    const auto var_m =
        static_cast<double>(std::int64_t{n} * s.mm[c] - std::int64_t{s.m[c]} * s.m[c]);
    const double n2 = static_cast<double>(n) * n;
    const double floor = static_cast<double>(c == 0 ? options_.floor_y : options_.floor_uv);
    const double weight = static_cast<double>(c == 0 ? options_.weight_y : options_.weight_uv);
    const double step_i = static_cast<double>(eye.grey_per_step[c]);
    const double step_m = static_cast<double>(set.grey_per_step[c]);
    const double floor_i = n2 * (floor / step_i) * (floor / step_i);
    const double floor_m = n2 * (floor / step_m) * (floor / step_m);
    const double grey_m = var_m / n2 * step_m * step_m;
    const double w = grey_m / (grey_m + weight * weight);
    sum += w * cov / std::sqrt((var_i + floor_i) * (var_m + floor_m));
    weights += w;
  }
  return weights > 0 ? sum / weights : 0;
}

double CorrelationFitness::eye_score(const PointSet& set, const CameraModel& camera,
                                     const EyePlanes& eye, int level, const PlaneView& view,
                                     Scratch& scratch) const {
  std::int32_t* index = scratch.index.data();
  const int split = set.inside_padded;
  const int rest = set.total_padded - split;
  const int n_in = camera.project(kernels_, set.x.data(), set.y.data(), split, view, level, index);
  const int n_out = camera.project(kernels_, set.x.data() + split, set.y.data() + split, rest, view,
                                   level, index + split);
  const double share = static_cast<double>(n_in + n_out) / set.points();
  if (share < static_cast<double>(options_.least_share)) return share - 1;
  const std::uint32_t* cells = eye.packed[static_cast<std::size_t>(level)].cells;
  CorrelationSums in, out;
  kernels_.correlate(cells, index, split, set.correlation.data(), n_in == set.inside, in);
  kernels_.correlate(cells, index + split, rest, set.correlation.data() + 4 * split,
                     n_out == set.outside, out);
  for (std::size_t c = 0; c < 3; ++c) {
    if (n_in == set.inside) in.m[c] = set.inside_sum[c], in.mm[c] = set.inside_squares[c];
    if (n_out == set.outside) {
      out.m[c] = set.sum[c] - set.inside_sum[c];
      out.mm[c] = set.sum_squares[c] - set.inside_squares[c];
    }
  }
  const double whole = mean_correlation(in + out, n_in + n_out, set, eye);
  const double inner = mean_correlation(in, n_in, set, eye);
  const double a = static_cast<double>(options_.inside_share);
  return ((1 - a) * whole + a * inner) *
         std::min(1.0, share / static_cast<double>(options_.full_share));
}

}  // namespace gannet::vision
