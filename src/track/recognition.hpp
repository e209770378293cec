// What the recogniser is asked and what it answers: values of the track room. RT safe.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "src/core/pose_estimate.hpp"

namespace gannet {
class Visitor;
}

namespace gannet::track {

// Where to look when nothing is known. Half-widths are about the midpoint between the optical
// axes; 0 means the cameras' common field of view.
struct SearchVolume {
  double z_min_m = 0.4;
  double z_max_m = 1.0;
  double half_width_x_m = 0;
  double half_width_y_m = 0;
  double tilt_rad = 40 * 3.14159265358979 / 180;  // |θx|, |θy| of R = Rz·Ry·Rx
  double roll_rad = 45 * 3.14159265358979 / 180;  // |θz|
};

// When to stop. stop, if given, is asked between rounds and may say that a deadline or a newer
// frame has come; replay leaves it null and is exact. A tracker asks it only while its target is in
// view: a search from nothing goes to its end.
struct Budget {
  double evaluations = 0;  // full stereo evaluations; 0: the configured default
  bool (*stop)(void* context) = nullptr;
  void* context = nullptr;
};

struct Recognition {
  bool found = false;
  bool refined = false;  // below a pixel; else the pose is the search's own
  TrackReason reason = TrackReason::kNotFound;
  Transform<LeftCamera, Target> left_from_target;
  Matrix6d covariance = Matrix6d::Zero();  // order as PoseEstimate
  Eigen::Vector2d size_m = Eigen::Vector2d::Zero();
  double fitness = 0;
  double likeness =
      0;  // of a photo-model by the fitness gannet, likeness.hpp: what found depends on
  // Of the pose and of the best place elsewhere, both on the coarsest level: what tells a target
  // from the best wrong answer.
  double coarse_fitness = 0;
  double rival_fitness = 0;
  double evaluations = 0;
  // While locked: a place elsewhere that looks better on the coarsest level.
  bool challenged = false;
  Transform<LeftCamera, Target> challenger;
};

}  // namespace gannet::track
