// SearchSpace: what the genes mean: a box in [0, 1]ⁿ ↔ hypotheses. Six genes: x and y across the
// width that may be searched at the depth, inverse depth (equal steps of disparity), and the angles
// of R = Rz·Ry·Rx. Three genes (Pb3DP, P004 §3.2): inverse depth on the patch's ray and two tilts.
// Decoding uses IEEE arithmetic only, so that a search takes the same path everywhere. RT safe.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "src/core/stereo_rig.hpp"
#include "src/track/recognition.hpp"
#include "src/vision/hypothesis.hpp"

namespace gannet::track {

class SearchSpace {
 public:
  // Six genes. The volume's half-widths are about the midpoint between the optical axes; 0 means
  // the common field of view at each depth. Start-up only.
  SearchSpace(const StereoRig& rig, const SearchVolume& volume);

  // Three genes: the patch's centre lies on this ray (x, y, 1) of the left camera.
  void fix_ray(const Eigen::Vector3d& ray);
  void free_ray() { three_ = false; }

  int dimension() const { return three_ ? 3 : 6; }
  vision::Hypothesis decode(std::span<const float> genes) const;
  // Whether a pose lies inside the box, or beyond it by no more than this share of its depth and
  // this angle.
  struct Slack {
    double depth_share = 0;
    double angle_rad = 0;
  };
  bool contains(const Transform<LeftCamera, Target>& pose, const Slack& slack) const;
  bool contains(const Transform<LeftCamera, Target>& pose) const { return contains(pose, {}); }
  // The genes of a pose; coordinates outside the box are put on its border.
  void encode(const Transform<LeftCamera, Target>& pose, std::span<float> genes) const;

 private:
  Eigen::Vector3d angles_of(const Eigen::Quaterniond& rotation) const;
  struct Range {  // linear in depth: low and high = offset + slope · z
    double low_offset = 0, low_slope = 0, high_offset = 0, high_slope = 0;
    double low(double z) const { return low_offset + low_slope * z; }
    double high(double z) const { return high_offset + high_slope * z; }
  };
  static Range field_of_view(const StereoRig& rig, int axis);

  bool three_ = false;
  Eigen::Vector3d ray_ = Eigen::Vector3d::UnitZ();
  Range x_, y_;
  double near_, far_;  // 1/m: inverse depths, near_ > far_
  double tilt_, roll_;
};

}  // namespace gannet::track
