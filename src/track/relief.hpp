// Relief: a locked target's points where stereo finds them, off the model's plane
// (vision/relief.hpp), and the frame's pose with them. Learned in rounds, each from poses
// with the relief of the round before: a flat model is tilted by what is not flat. Used where it
// pays: while the refinement leaves clearly less with it than without, which both are asked in
// every frame; given up for good where it does not. Comes and goes over some frames, so that no
// pose jumps. One thread; all but creation RT safe. Measured in docs/design/relief.md.
#pragma once

#include <Eigen/Core>

#include "src/vision/refine.hpp"
#include "src/vision/relief.hpp"

namespace gannet::track {

class Relief {
 public:
  explicit Relief(int max_points);  // start-up only

  // Another target. Arguments as vision::ReliefEstimator::reset.
  void reset(const vision::PointSet& flat, double spacing_m, const Eigen::Vector3d& eye_m);

  // The answer for this frame; flat: the refinement with flat points. locked: the target is surely
  // there, so that the frame may be learned from.
  vision::Refinement refine(const vision::RigOptics& optics, const vision::PointSet& flat_points,
                            const vision::PreparedFrame& frame, const vision::Refinement& flat,
                            const vision::RefineOptions& options, bool locked);

  bool in_use() const { return in_use_; }

 private:
  vision::ReliefEstimator estimator_;
  vision::PointSet solid_;
  double spacing_m_ = 0;
  Eigen::Vector3d eye_m_ = -Eigen::Vector3d::UnitZ();
  int rounds_ = 0;    // learned
  double gain_ = 0;   // running mean of the log of the variance left with it over that without
  double share_ = 0;  // of the relief in the answer
  bool in_use_ = false;
  int idle_ = 0;  // frames with a relief that did not pay
};

}  // namespace gannet::track
