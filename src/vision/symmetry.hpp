// Symmetry: turns about its own normal by which a target cannot be told from itself. Found from the
// photo when a model is built; a tracker then stays with one of the poses that look alike. Finding
// is start-up only, choosing is RT safe.
#pragma once

#include <Eigen/Core>

#include "src/core/transform.hpp"
#include "src/vision/patch_model.hpp"

namespace gannet::vision {

// −1 … 1: correlation of the target on its mean background with the same turned by angle_rad about
// its origin, over the disc that holds both; Y, U and V centred one by one, then pooled. 1 at 0;
// 0 also where nothing is to be seen at all. Any thread, no heap.
double likeness_when_rolled(const PhotoPatch& patch, double angle_rad);

// Looked for every 5°, at least 30° from none: likeness above 0.9 and no smaller than 5° to either
// side; any_roll where it is above everywhere. Start-up only.
Symmetry symmetry_of(const PhotoPatch& patch);

// Of the poses that look like `pose`, the one nearest to an attitude (a rotation of the same
// frames). RT safe.
Transform<LeftCamera, Target> nearest_equivalent(const Symmetry& symmetry,
                                                 const Transform<LeftCamera, Target>& pose,
                                                 const Eigen::Quaterniond& attitude);

// The photo's colour (Y, U, V) at a place on the target's plane, metres, bilinear. False: beside
// the target, or so near its outline that a neighbour is. Any thread, no heap.
bool sample_photo(const PhotoPatch& patch, const Eigen::Vector2d& at_m, Eigen::Vector3d& colour);

}  // namespace gannet::vision
