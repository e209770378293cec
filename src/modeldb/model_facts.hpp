// What a model's photo says about tracking it, before any frame is seen: how alike it is to itself
// when rolled, and how well its texture fixes a pose (Cramér–Rao). Start-up only, any thread.
#pragma once

#include <optional>
#include <vector>

#include "src/core/pose_estimate.hpp"
#include "src/core/stereo_rig.hpp"
#include "src/vision/patch_model.hpp"

namespace gannet::modeldb {

// −1 … 1: correlation of the target on its mean background with the same turned by angle_rad about
// its origin, over the disc that holds both; Y, U and V centred one by one, then pooled. 1 at 0;
// 0 also where nothing is to be seen at all.
double likeness_when_rolled(const vision::PhotoPatch& patch, double angle_rad);

// Rolls that this target cannot be told from: every 5°, at least 30° from none, likeness above
// 0.9 and no smaller than 5° to either side. Radians in (0, π]; a roll and its opposite are one.
std::vector<double> ambiguous_rolls(const vision::PhotoPatch& patch);

// Least standard deviations that one pair of frames can give of x, y, z (m) and of the turns about
// x, y, z (rad): the roots of the diagonal of (Σ JᵀJ/σ²)⁻¹ over the pixels inside the silhouette in
// both eyes, three channels of white noise. The target faces the left camera, depth_m before the
// middle of the hand. The outline counts for nothing and brightness is taken as known. None where
// the texture leaves a direction free or the target is not seen.
std::optional<Vector6d> least_sigma(const vision::PhotoPatch& patch, const StereoRig& rig,
                                    double depth_m, double noise_grey_levels);

}  // namespace gannet::modeldb
