// ReliefEstimator: creatures are round, models are flat. While a target is locked it finds by
// stereo how far each point lies behind or before the model's plane: for a slice of the points in
// each frame it compares the left image with the right one at a row of depths along the ray that
// the photo saw the point on, and when all have been compared often enough, takes the best depth
// of each point with its neighbours. The refinement can look at the points there (PointSet::z);
// whether that pays is for its caller to watch. The vision thread's; all but creation RT safe.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "src/vision/refine.hpp"

namespace gannet::vision {

class ReliefEstimator {
 public:
  explicit ReliefEstimator(int max_points);  // start-up only

  // Forgets everything. flat: at full detail; eye_m: where the photo was taken from, in the
  // target's frame; spacing_m: of the points.
  void reset(const PointSet& flat, double spacing_m, const Eigen::Vector3d& eye_m);

  // One frame's share of the work. seen: flat's refinement in this frame.
  void see(const StereoRig& rig, const PointSet& flat, const PreparedFrame& frame,
           const Refinement& seen);
  bool complete() const { return stage_ == Stage::kComplete; }

  // Moves flat's points to where they were found to be. complete() only; solid must have room.
  void lay(const PointSet& flat, PointSet& solid) const;

 private:
  enum class Stage { kCompare, kChoose, kBlend, kComplete };
  static constexpr int kDepths = 41;  // odd: the middle one is the plane

  double depth(double index) const { return (index - (kDepths - 1) / 2) * step_m_; }
  Eigen::Vector3d at_depth(const PointSet& flat, std::size_t point, double z) const;
  void compare(const StereoRig& rig, const PointSet& flat, const PreparedFrame& frame,
               const Refinement& seen, std::size_t point);
  void choose(const PointSet& flat, std::size_t point);
  void blend(const PointSet& flat, std::size_t point);
  template <class Visit>
  void for_neighbours(const PointSet& flat, std::size_t point, Visit&& visit) const;

  Stage stage_ = Stage::kComplete;
  std::size_t next_ = 0;  // point
  int passes_ = 0;
  double step_m_ = 0, radius_m_ = 0;
  Eigen::Vector3d eye_m_ = Eigen::Vector3d::Zero();
  std::vector<float> cost_;  // kDepths for each point, summed over frames
  std::vector<float> frames_;
  std::vector<float> chosen_, certainty_, z_;
};

}  // namespace gannet::vision
