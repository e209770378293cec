// The fitness "p000": Pb3DP (P000 Eq. 1–9, P004 Eq. 2–8). Points of the left image are carried over
// the hypothesis's plane into the right one and compared with their own hue and value:
// F = F_H + F_B − F_H·F_B. Wants unscaled target points. RT safe.
#pragma once

#include "src/vision/fitness.hpp"

namespace gannet::vision {

// Eq. 9 of P000 from the counts over S_in and S_out.
double projection_votes(const ProjectionCounts& inside, const ProjectionCounts& outside,
                        int inside_points, int outside_points);

class ProjectionFitness final : public Fitness {
 public:
  ProjectionFitness(const StereoRig& rig, const Kernels& kernels);

  PlaneNeeds needs() const override { return {.packed = false, .hue_value = true}; }
  int levels(const TargetPoints&) const override { return 1; }
  void score(const TargetPoints& target, const PreparedFrame& frame, int level,
             std::span<const Hypothesis> hypotheses, std::span<float> scores,
             Scratch& scratch) const override;
  float weaker_eye(const TargetPoints& target, const PreparedFrame& frame,
                   const Hypothesis& hypothesis, Scratch& scratch) const override;

 private:
  CameraModel right_;
  const Kernels& kernels_;
};

}  // namespace gannet::vision
