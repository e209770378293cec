// The reference of all fitnesses: double precision, straight from the equations, a loop per point
// and no tricks. Nothing at run time uses it; tests and benchmarks measure against it.
// Any thread.
#pragma once

#include <optional>

#include "src/vision/correlation_fitness.hpp"
#include "src/vision/fitness.hpp"
#include "src/vision/photo_model_fitness.hpp"

namespace gannet::vision::reference {

// Whole pixel of the target's point (x, y) at a pose in one eye, by the rig's own projection
// (P001 Eq. 1–3); empty outside the image. For unscaled targets (x, y) is a ray of the left camera
// and the pose gives the plane that it meets (P004 Eq. 2–4).
std::optional<Eigen::Vector2i> pixel_of(const StereoRig& rig, bool left_eye,
                                        const Transform<LeftCamera, Target>& pose, double x,
                                        double y, bool unscaled);

double photo_model(const StereoRig& rig, const TargetPoints& target, const PreparedFrame& frame,
                   const Transform<LeftCamera, Target>& pose, VoteRule rule);
double projection(const StereoRig& rig, const TargetPoints& target, const PreparedFrame& frame,
                  const Transform<LeftCamera, Target>& pose);
// On the smoothed bytes, without the 7-bit cells: equal to the kernels' up to their rounding.
double correlation(const StereoRig& rig, const TargetPoints& target, const PreparedFrame& frame,
                   const Transform<LeftCamera, Target>& pose, const CorrelationOptions& options);

}  // namespace gannet::vision::reference
