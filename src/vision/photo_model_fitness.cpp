#include "src/vision/photo_model_fitness.hpp"

#include <algorithm>

namespace gannet::vision {

double photo_model_votes(VoteRule rule, const VoteCounts& c) {
  // P002 has no class "far": what is not a match votes by the background alone.
  const int background =
      rule == VoteRule::kP001 ? c.in_background : c.in_background + c.in_far_background;
  const double far = rule == VoteRule::kP001 ? -1.0 * c.in_far : 0.0;
  return 2.0 * c.in_match + far - 0.005 * background + 0.1 * c.out_background - 0.5 * c.out_other;
}

PhotoModelFitness::PhotoModelFitness(const StereoRig& rig, const Kernels& kernels, VoteRule rule)
    : left_(rig.left, nullptr),
      right_(rig.right, &rig.right_from_left),
      kernels_(kernels),
      rule_(rule) {}

double PhotoModelFitness::eye_votes(const TargetPoints& target, const PointSet& set,
                                    const CameraModel& camera, const EyePlanes& eye,
                                    const Hypothesis& hypothesis, Scratch& scratch) const {
  const int guard = eye.width * eye.height;
  const PlaneView view = camera.view(hypothesis, set.reach, 0, eye.width, eye.height, guard);
  std::int32_t* index = scratch.index.data();
  camera.project(kernels_, set.x.data(), set.y.data(), set.total_padded, view, 0, index);
  VoteCounts counts;
  kernels_.vote(eye.hue_value, index, set.inside_padded, set.total_padded - set.inside_padded,
                guard, set.hue.data(), set.is_background.data(), target.background_hue, counts);
  return photo_model_votes(rule_, counts);
}

void PhotoModelFitness::score(const TargetPoints& target, const PreparedFrame& frame, int level,
                              std::span<const Hypothesis> hypotheses, std::span<float> scores,
                              Scratch& scratch) const {
  const PointSet& set = target.level[static_cast<std::size_t>(level)];
  for (std::size_t k = 0; k < hypotheses.size(); ++k) {
    const double votes = eye_votes(target, set, left_, frame.left(), hypotheses[k], scratch) +
                         eye_votes(target, set, right_, frame.right(), hypotheses[k], scratch);
    scores[k] = static_cast<float>(votes / (2.0 * set.points()));
  }
}

float PhotoModelFitness::weaker_eye(const TargetPoints& target, const PreparedFrame& frame,
                                    const Hypothesis& hypothesis, Scratch& scratch) const {
  const PointSet& set = target.level[0];
  const double votes = std::min(eye_votes(target, set, left_, frame.left(), hypothesis, scratch),
                                eye_votes(target, set, right_, frame.right(), hypothesis, scratch));
  return static_cast<float>(votes / set.points());
}

}  // namespace gannet::vision
