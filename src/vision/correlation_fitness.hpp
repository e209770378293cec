// The fitness "gannet", our default: the zero-mean normalised correlation of image and model over
// S_in and S_out, for each of Y, U, V and each eye, averaged with weights. At one depth attenuation
// with backscatter is an affine map of each colour channel, and so are gain and darkness; the
// correlation does not see one (docs/design/fitness.md). −1 … 1. RT safe.
#pragma once

#include "src/vision/fitness.hpp"

namespace gannet::vision {

struct CorrelationOptions {
  // Standard deviations (grey levels) that noise alone could have, added in quadrature to the
  // image's and the model's: where there is less contrast a channel counts for nothing.
  float floor_y = 3;
  float floor_uv = 2;
  // A channel of the model counts with var / (var + weight²).
  float weight_y = 12;
  float weight_uv = 5;
  // Share of S_in's own correlation in the score; the rest is S_in and S_out together. S_out gives
  // a wide basin and holds plain targets, but behind it a textured ground is noise.
  float inside_share = 0.5f;
  // Share of the points that an eye must see for full marks, and to count at all.
  float full_share = 0.85f;
  float least_share = 0.5f;
};

class CorrelationFitness final : public Fitness {
 public:
  CorrelationFitness(const StereoRig& rig, const Kernels& kernels,
                     const CorrelationOptions& options = {});

  PlaneNeeds needs() const override { return {.packed = true}; }
  int levels(const TargetPoints& target) const override { return target.levels; }
  void score(const TargetPoints& target, const PreparedFrame& frame, int level,
             std::span<const Hypothesis> hypotheses, std::span<float> scores,
             Scratch& scratch) const override;
  float weaker_eye(const TargetPoints& target, const PreparedFrame& frame,
                   const Hypothesis& hypothesis, Scratch& scratch) const override;

 private:
  double mean_correlation(const CorrelationSums& sums, int n, const PointSet& set,
                          const EyePlanes& eye) const;
  double eye_score(const PointSet& set, const CameraModel& camera, const EyePlanes& eye, int level,
                   const PlaneView& view, Scratch& scratch) const;

  CameraModel left_;
  CameraModel right_;
  const Kernels& kernels_;
  CorrelationOptions options_;
};

}  // namespace gannet::vision
