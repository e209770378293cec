// Refinement: from a good hypothesis to the sub-pixel optimum by Gauss–Newton on the smoothed
// images (bilinear samples), with a gain and an offset for each channel and eye as nuisances and
// Cauchy weights against what covers the target. Gives the covariance that the residuals imply,
// (Jᵀ W J)⁻¹ over both images. RT safe (fixed-size Eigen, no heap).
#pragma once

#include <array>

#include "src/core/pose_estimate.hpp"
#include "src/vision/fitness.hpp"
#include "src/vision/port_optics.hpp"

namespace gannet::vision {

struct RefineOptions {
  int iterations = 8;
  int level = 0;  // of the pyramid
  // A last step of so many standard deviations ends it; what it leaves is a tenth of that.
  double sigmas_stop = 0.1;
  double outside_weight = 0.3;  // of S_out's residuals: the background is only known by its mean
  // The surroundings of the photo are blurred into what is near the outline, and those of the frame
  // are others: this pulls at the pose. Points away from the outline alone end the refinement where
  // no standard deviation grows by more than this factor without the others, at full size.
  double core_suffices = 2.5;
  // Neighbouring samples of a smoothed image share noise: what independent samples would give is
  // this much too good, as a variance.
  double shared_noise = 4.0;
};

struct Refinement {
  // What a channel of an eye looks like: image = gain · model + offset, both less 128, and the
  // variance of what is left.
  struct Look {
    double gain = 0, offset = 0, variance = 0;
    bool ok = false;
  };

  bool ok = false;  // converged to a place with a full-rank covariance
  Transform<LeftCamera, Target> left_from_target;
  Matrix6d covariance = Matrix6d::Zero();  // order as PoseEstimate
  // Y U V of the left eye, then of the right one; over the points away from the outline where there
  // are any.
  std::array<Look, 6> looks;
};

// Metric points on the target's plane, both eyes, six degrees of freedom.
Refinement refine_pose(const RigOptics& optics, const PointSet& points, const PreparedFrame& frame,
                       const Transform<LeftCamera, Target>& start, const RefineOptions& options);

// Ray points of the left image, right eye, the plane's three degrees of freedom; centre is the ray
// (x, y, 1) through the patch's centre.
Refinement refine_plane(const RigOptics& optics, const PointSet& points, const PreparedFrame& frame,
                        const Transform<LeftCamera, Target>& start, const Eigen::Vector3d& centre,
                        const RefineOptions& options);

// The pose of a plane (n/d of n·p = d, left camera) on a ray: position where they meet, rotation
// the smallest one from +z to the normal.
Transform<LeftCamera, Target> pose_of_plane(const Eigen::Vector3d& normal_over_distance,
                                            const Eigen::Vector3d& ray);

}  // namespace gannet::vision
