// The fitnesses "p001" and "p002": votes of hues over S_in and S_out in both images, literal to
// P001 Eq. 4–6 and P002 Eq. 4–6, except that hue is circular. F = (ΣR + ΣL) / (2 N). RT safe.
#pragma once

#include "src/vision/fitness.hpp"

namespace gannet::vision {

enum class VoteRule : std::uint8_t { kP001, kP002 };

// The factors of the papers, applied to the counts at the end.
double photo_model_votes(VoteRule rule, const VoteCounts& counts);

class PhotoModelFitness final : public Fitness {
 public:
  PhotoModelFitness(const StereoRig& rig, const Kernels& kernels, VoteRule rule);

  PlaneNeeds needs() const override { return {.packed = false, .hue_value = true}; }
  int levels(const TargetPoints&) const override { return 1; }
  void score(const TargetPoints& target, const PreparedFrame& frame, int level,
             std::span<const Hypothesis> hypotheses, std::span<float> scores,
             Scratch& scratch) const override;
  float weaker_eye(const TargetPoints& target, const PreparedFrame& frame,
                   const Hypothesis& hypothesis, Scratch& scratch) const override;

 private:
  double eye_votes(const TargetPoints& target, const PointSet& set, const CameraModel& camera,
                   const EyePlanes& eye, const Hypothesis& hypothesis, Scratch& scratch) const;

  CameraModel left_;
  CameraModel right_;
  const Kernels& kernels_;
  VoteRule rule_;
};

}  // namespace gannet::vision
