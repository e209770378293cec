// PoseEstimate: what vision says of one target in one frame. A value that crosses threads, so it
// carries its time; the reader states the age that it tolerates. RT safe.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "platform/base/time.hpp"
#include "src/core/transform.hpp"

namespace gannet {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

enum class TrackState : std::uint8_t { kSearching, kLocked, kCoasting, kLost };
const char* to_string(TrackState state);  // "searching" …

// Why a track is in its state; kNone while all is well.
enum class TrackReason : std::uint8_t {
  kNone,
  kNoTarget,    // nothing is asked for
  kNotFound,    // the best score is under the threshold
  kLowFitness,  // was locked, score fell
  kJumped,      // found, but farther than motion allows
  kOutOfView,   // too little of the model is inside the images
  kNoFrames,    // the cameras are silent
};
const char* to_string(TrackReason reason);

struct PoseEstimate {
  TimePoint capture_time;  // middle of the exposure that it was seen in
  std::uint64_t frame_number = 0;
  std::uint32_t target_id = 0;  // counts chosen targets from 1; 0: none
  std::int32_t model = -1;      // index in the daemon's list of models; −1: a live rectangle
  bool found = false;           // pose fields mean something
  TrackState state = TrackState::kSearching;
  TrackReason reason = TrackReason::kNoTarget;
  Transform<LeftCamera, Target> left_from_target;
  // Of (x, y, z, rx, ry, rz): m² and rad², position and a small rotation vector, both expressed in
  // the left camera's frame.
  Matrix6d covariance = Matrix6d::Zero();
  Eigen::Vector2d size_m = Eigen::Vector2d::Zero();  // width, height on the target's plane
  double fitness = 0;
  double evaluations = 0;    // points scored / (points of the model × 2)
  Duration time_spent = {};  // decoded images → pose
};

}  // namespace gannet
