#include "src/vision/photo_model_fitness.hpp"

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

void PhotoModelFitness::score(const TargetPoints& target, const PreparedFrame& frame, int level,
                              std::span<const Hypothesis> hypotheses, std::span<float> scores,
                              Scratch& scratch) const {
  const PointSet& set = target.level[static_cast<std::size_t>(level)];
  for (std::size_t k = 0; k < hypotheses.size(); ++k) {
    double votes = 0;
    for (const bool is_left : {true, false}) {
      const CameraModel& camera = is_left ? left_ : right_;
      const EyePlanes& eye = is_left ? frame.left() : frame.right();
      const int guard = eye.width * eye.height;
      const PlaneView view = camera.view(hypotheses[k], 0, eye.width, eye.height, guard);
      std::int32_t* index = scratch.index.data();
      camera.project(kernels_, set.x.data(), set.y.data(), set.total_padded, view, 0, index);
      VoteCounts counts;
      kernels_.vote(eye.hue_value, index, set.inside_padded, set.total_padded - set.inside_padded,
                    guard, set.hue.data(), set.is_background.data(), target.background_hue, counts);
      votes += photo_model_votes(rule_, counts);
    }
    scores[k] = static_cast<float>(votes / (2.0 * set.points()));
  }
}

}  // namespace gannet::vision
