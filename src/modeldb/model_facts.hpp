// What a model's photo says about tracking it, before any frame is seen: how well its texture
// fixes a pose (Cramér–Rao). Start-up only, any thread.
#pragma once

#include <optional>

#include "src/core/pose_estimate.hpp"
#include "src/core/stereo_rig.hpp"
#include "src/vision/patch_model.hpp"

namespace gannet::modeldb {

// Least standard deviations that one pair of frames can give of x, y, z (m) and of the turns about
// x, y, z (rad): the roots of the diagonal of (Σ JᵀJ/σ²)⁻¹ over the pixels inside the silhouette in
// both eyes, three channels of white noise. The target faces the left camera, depth_m before the
// middle of the hand. The outline counts for nothing and brightness is taken as known. None where
// the texture leaves a direction free or the target is not seen.
std::optional<Vector6d> least_sigma(const vision::PhotoPatch& patch, const StereoRig& rig,
                                    double depth_m, double noise_grey_levels);

}  // namespace gannet::modeldb
