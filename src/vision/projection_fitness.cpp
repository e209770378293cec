#include "src/vision/projection_fitness.hpp"

#include <algorithm>

namespace gannet::vision {

double projection_votes(const ProjectionCounts& in, const ProjectionCounts& out, int inside_points,
                        int outside_points) {
  const double whole = 2.0 * inside_points + 0.1 * outside_points;
  const auto part = [whole](int in_match, int in_other, int out_match, int out_other) {
    return std::max(0.0, (2.0 * in_match - in_other + 0.1 * out_match - 1.0 * out_other) / whole);
  };
  const double hue = part(in.hue_match, in.hue_other, out.hue_match, out.hue_other);
  const double value = part(in.value_match, in.value_other, out.value_match, out.value_other);
  return hue + value - hue * value;
}

ProjectionFitness::ProjectionFitness(const StereoRig& rig, const Kernels& kernels)
    : right_(rig.right, &rig.right_from_left), kernels_(kernels) {}

void ProjectionFitness::score(const TargetPoints& target, const PreparedFrame& frame, int level,
                              std::span<const Hypothesis> hypotheses, std::span<float> scores,
                              Scratch& scratch) const {
  const PointSet& set = target.level[static_cast<std::size_t>(level)];
  const EyePlanes& eye = frame.right();
  const int guard = eye.width * eye.height;
  std::int32_t* index = scratch.index.data();
  const int n_out = set.total_padded - set.inside_padded;
  for (std::size_t k = 0; k < hypotheses.size(); ++k) {
    const PlaneView view =
        right_.ray_view(hypotheses[k], set.reach, 0, eye.width, eye.height, guard);
    right_.project(kernels_, set.x.data(), set.y.data(), set.total_padded, view, 0, index);
    ProjectionCounts in, out;
    kernels_.compare(eye.hue_value, index, set.inside_padded, guard, set.hue_value.data(), in);
    kernels_.compare(eye.hue_value, index + set.inside_padded, n_out, guard,
                     set.hue_value.data() + set.inside_padded, out);
    scores[k] = static_cast<float>(projection_votes(in, out, set.inside, set.outside));
  }
}

// The left image is where the rectangle came from: the right eye alone says how well it fits.
float ProjectionFitness::weaker_eye(const TargetPoints& target, const PreparedFrame& frame,
                                    const Hypothesis& hypothesis, Scratch& scratch) const {
  float result = 0;
  score(target, frame, 0, {&hypothesis, 1}, {&result, 1}, scratch);
  return result;
}

}  // namespace gannet::vision
