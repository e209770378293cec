// PoseFilter: late, noisy poses of one target in, the target's pose and motion now out.
// Error-state Kalman filter; states are the target's position, orientation, linear and angular
// velocity in the left camera's axes, the velocities those of the target itself: the camera's own
// motion, told by note_own_motion, is taken out as a rigid displacement between the two times.
// So what the vehicle does on command is not mistaken for the target's motion, and prediction over
// the image's latency uses what was commanded in it. Where nobody tells the own motion, the
// velocities are relative to the camera, and all else holds.
// Model: constant velocity, white acceleration (Bar-Shalom, Li, Kirubarajan, Estimation with
// Applications to Tracking and Navigation, 2001, Eq. 6.2.2-12); orientation error as a rotation
// vector in the camera's axes, R_true = exp(δθ)·R (Solà, "Quaternion kinematics for the
// error-state Kalman filter", arXiv 1711.02508, 2017, §7).
// Fixed size, no heap. Servo thread; RT safe.
#pragma once

#include <array>
#include <cstdint>

#include "src/core/motion.hpp"
#include "src/core/pose_estimate.hpp"
#include "src/core/predicted_pose.hpp"
#include "src/track/filter_config.hpp"

namespace gannet::track {

// Own velocity of the camera over the last second or more; integrates it to a displacement.
class OwnMotion {
 public:
  // From time on, until the next call, the camera moves so. Times that run backwards are ignored.
  void note(TimePoint time, const Twist<LeftCamera>& twist);
  // The camera's frame at `to`, seen from its frame at `from` (to ≥ from). Before the oldest and
  // after the newest note, those velocities are taken on.
  Transform<LeftCamera, LeftCamera> displacement(TimePoint from, TimePoint to) const;
  Twist<LeftCamera> at(TimePoint time) const;

 private:
  static constexpr int kSize = 1024;  // 1 s at 1 kHz, 5 s at 200 Hz
  struct Note {
    TimePoint time;
    Twist<LeftCamera> twist;
  };
  const Note& back(int i) const;  // the i-th newest
  int index_at(TimePoint time) const;
  std::array<Note, kSize> notes_ = {};
  int next_ = 0;
  int count_ = 0;
};

enum class FilterResult : std::uint8_t {
  kStarted,  // the first one, after a long gap or of another target
  kUpdated,
  kReset,       // started anew after too many rejections in a row
  kRejected,    // outside the gate
  kNotFound,    // the estimate has no pose
  kOutOfOrder,  // not newer than the newest one
  kFuture,      // taken later than now
  kInvalid,     // numbers that no measurement has
};

class PoseFilter {
 public:
  explicit PoseFilter(const FilterConfig& config) : config_(config) {}

  void note_own_motion(TimePoint time, const Twist<LeftCamera>& twist) {
    own_motion_.note(time, twist);
  }
  FilterResult update(const PoseEstimate& estimate, TimePoint now);
  PredictedPose predict(TimePoint now) const;
  void clear() { started_ = false; }

  struct Counters {
    std::uint64_t updated = 0, rejected = 0, resets = 0, out_of_order = 0, invalid = 0;
  };
  const Counters& counters() const { return counters_; }
  double last_distance() const { return distance_; }  // squared Mahalanobis of the newest one

 private:
  struct Belief {
    TimePoint time = {};
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
    TargetVelocity velocity;
    Matrix12d covariance = Matrix12d::Zero();
  };
  void start(const PoseEstimate& estimate, const Matrix6d& noise);
  Belief moved_to(TimePoint time) const;
  bool correct(Belief& belief, const PoseEstimate& estimate, const Matrix6d& noise);

  FilterConfig config_;
  OwnMotion own_motion_;
  Belief belief_;
  bool started_ = false;
  std::uint32_t target_id_ = 0;
  int rejections_ = 0;
  double distance_ = 0;
  Counters counters_;
};

}  // namespace gannet::track
