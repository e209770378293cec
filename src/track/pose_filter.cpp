#include "src/track/pose_filter.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace gannet::track {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// Left Jacobian of SO(3): exp(v + δ) ≈ exp(J δ)·exp(v).
Matrix3d left_jacobian(const Vector3d& v) {
  const double angle = v.norm();
  const Matrix3d k = cross_matrix(v);
  if (angle < 1e-4) return Matrix3d::Identity() + k / 2 + k * k / 6;
  const double square = angle * angle;
  return Matrix3d::Identity() + (1 - std::cos(angle)) / square * k +
         (angle - std::sin(angle)) / (square * angle) * k * k;
}

// Half a turn is as far as a rotation vector goes; rotations and the rest are integrated exactly
// for a constant twist.
Transform<LeftCamera, LeftCamera> exponential(const Twist<LeftCamera>& twist, double dt) {
  const Vector3d angle = twist.angular * dt;
  return {quaternion_from_rotation_vector(angle), left_jacobian(angle) * twist.linear * dt};
}

Matrix6d floored(const Matrix6d& covariance, const FilterConfig& config) {
  Matrix6d noise = (covariance + covariance.transpose()) / 2;
  noise.diagonal().head<3>().array() += config.least_sigma_m * config.least_sigma_m;
  noise.diagonal().tail<3>().array() += config.least_sigma_rad * config.least_sigma_rad;
  return noise;
}

bool is_measurement(const PoseEstimate& estimate, const Matrix6d& noise) {
  const auto& pose = estimate.left_from_target;
  if (!pose.translation.allFinite() || !noise.allFinite()) return false;
  if (!(std::abs(pose.rotation.norm() - 1) < 1e-3)) return false;
  return Eigen::LLT<Matrix6d>(noise).info() == Eigen::Success;
}

}  // namespace

void OwnMotion::note(TimePoint time, const Twist<LeftCamera>& twist) {
  if (count_ > 0 && time <= back(0).time) return;
  notes_[static_cast<std::size_t>(next_)] = {time, twist};
  next_ = (next_ + 1) % kSize;
  count_ = std::min(count_ + 1, kSize);
}

const OwnMotion::Note& OwnMotion::back(int i) const {
  return notes_[static_cast<std::size_t>((next_ - 1 - i + 2 * kSize) % kSize)];
}

// The newest note that is not later than time; the oldest one if all are.
int OwnMotion::index_at(TimePoint time) const {
  int i = 0;
  while (i < count_ - 1 && back(i).time > time) ++i;
  return i;
}

Twist<LeftCamera> OwnMotion::at(TimePoint time) const {
  return count_ == 0 ? Twist<LeftCamera>() : back(index_at(time)).twist;
}

Transform<LeftCamera, LeftCamera> OwnMotion::displacement(TimePoint from, TimePoint to) const {
  Transform<LeftCamera, LeftCamera> moved;
  if (count_ == 0) return moved;
  TimePoint time = from;
  for (int i = index_at(from); time < to; --i) {
    const TimePoint end = i > 0 ? std::min(back(i - 1).time, to) : to;
    moved = moved * exponential(back(i).twist, to_seconds(end - time));
    time = end;
  }
  return moved;
}

// Within the interval the frame of its beginning stands still: the target moves with constant
// velocity in it, and the camera by its displacement; then all is seen from where the camera is.
PoseFilter::Belief PoseFilter::moved_to(TimePoint time) const {
  const double dt = to_seconds(time - belief_.time);
  const auto now_from_then = own_motion_.displacement(belief_.time, time).inverse();
  const Matrix3d turn = now_from_then.rotation.toRotationMatrix();
  const Vector3d angle = belief_.velocity.angular * dt;
  const Eigen::Quaterniond spin = quaternion_from_rotation_vector(angle);

  Belief b;
  b.time = time;
  b.position = now_from_then(belief_.position + belief_.velocity.linear * dt);
  b.rotation = (now_from_then.rotation * spin * belief_.rotation).normalized();
  b.velocity.linear = turn * belief_.velocity.linear;
  b.velocity.angular = turn * belief_.velocity.angular;

  Matrix12d f = Matrix12d::Zero();
  f.block<3, 3>(0, 0) = turn;
  f.block<3, 3>(0, 6) = turn * dt;
  f.block<3, 3>(3, 3) = turn * spin.toRotationMatrix();
  f.block<3, 3>(3, 9) = turn * left_jacobian(angle) * dt;
  f.block<3, 3>(6, 6) = turn;
  f.block<3, 3>(9, 9) = turn;
  const Matrix12d half = f * belief_.covariance;
  b.covariance = half * f.transpose();
  for (int k = 0; k < 2; ++k) {
    const double density =
        k == 0 ? config_.acceleration_density : config_.angular_acceleration_density;
    const double q = density * density;
    for (int i = 3 * k; i < 3 * k + 3; ++i) {
      b.covariance(i, i) += q * dt * dt * dt / 3;
      b.covariance(i, i + 6) += q * dt * dt / 2;
      b.covariance(i + 6, i) += q * dt * dt / 2;
      b.covariance(i + 6, i + 6) += q * dt;
    }
  }
  return b;
}

void PoseFilter::start(const PoseEstimate& estimate, const Matrix6d& noise) {
  belief_ = Belief();
  belief_.time = estimate.capture_time;
  belief_.position = estimate.left_from_target.translation;
  belief_.rotation = estimate.left_from_target.rotation.normalized();
  belief_.covariance.topLeftCorner<6, 6>() = noise;
  const double v = config_.initial_speed_m_s;
  const double w = config_.initial_rate_rad_s;
  // What is seen first is most often at rest: in the world where the own motion is told.
  belief_.covariance.diagonal().segment<3>(6).setConstant(v * v);
  belief_.covariance.diagonal().segment<3>(9).setConstant(w * w);
  started_ = true;
  target_id_ = estimate.target_id;
  rejections_ = 0;
}

bool PoseFilter::correct(Belief& b, const PoseEstimate& estimate, const Matrix6d& noise) {
  const auto& seen = estimate.left_from_target;
  Vector6d innovation;
  innovation.head<3>() = seen.translation - b.position;
  innovation.tail<3>() = rotation_vector_from_quaternion(seen.rotation * b.rotation.conjugate());
  const Matrix6d s = b.covariance.topLeftCorner<6, 6>() + noise;
  const Eigen::LLT<Matrix6d> factor(s);
  distance_ = innovation.dot(factor.solve(innovation));
  if (factor.info() != Eigen::Success || !(distance_ <= config_.gate)) return false;

  const Eigen::Matrix<double, 12, 6> ph = b.covariance.leftCols<6>();
  const Eigen::Matrix<double, 12, 6> gain = factor.solve(ph.transpose()).transpose();
  const Eigen::Matrix<double, 12, 1> change = gain * innovation;
  b.position += change.head<3>();
  b.rotation = (quaternion_from_rotation_vector(change.segment<3>(3)) * b.rotation).normalized();
  b.velocity.linear += change.segment<3>(6);
  b.velocity.angular += change.tail<3>();
  // Joseph's form stays symmetric and positive whatever the rounding.
  Matrix12d keep = Matrix12d::Identity();
  keep.leftCols<6>() -= gain;
  const Matrix12d kept = keep * b.covariance;
  const Eigen::Matrix<double, 12, 6> noisy = gain * noise;
  b.covariance = kept * keep.transpose();
  b.covariance += noisy * gain.transpose();
  return true;
}

FilterResult PoseFilter::update(const PoseEstimate& estimate, TimePoint now) {
  if (!estimate.found) return FilterResult::kNotFound;
  if (estimate.capture_time > now) {
    ++counters_.invalid;
    return FilterResult::kFuture;
  }
  const Matrix6d noise = floored(estimate.covariance, config_);
  if (!is_measurement(estimate, noise)) {
    ++counters_.invalid;
    return FilterResult::kInvalid;
  }
  const bool same = started_ && estimate.target_id == target_id_;
  if (same && estimate.capture_time <= belief_.time) {
    ++counters_.out_of_order;
    return FilterResult::kOutOfOrder;
  }
  if (!same || estimate.capture_time - belief_.time > from_seconds(config_.longest_gap_s)) {
    start(estimate, noise);
    return FilterResult::kStarted;
  }
  Belief b = moved_to(estimate.capture_time);
  if (correct(b, estimate, noise)) {
    belief_ = b;
    rejections_ = 0;
    ++counters_.updated;
    return FilterResult::kUpdated;
  }
  ++counters_.rejected;
  if (++rejections_ < config_.rejections_to_reset) return FilterResult::kRejected;
  start(estimate, noise);
  ++counters_.resets;
  return FilterResult::kReset;
}

PredictedPose PoseFilter::predict(TimePoint now) const {
  PredictedPose out;
  out.time = now;
  if (!started_) return out;
  out.age = now - belief_.time;
  if (out.age < Duration(0) || out.age > from_seconds(config_.longest_prediction_s)) return out;
  const Belief b = config_.predict ? moved_to(now) : belief_;
  const Twist<LeftCamera> own = own_motion_.at(b.time);
  out.valid = true;
  out.target_id = target_id_;
  out.left_from_target = {b.rotation, b.position};
  out.target = b.velocity;
  out.relative.linear = b.velocity.linear - own.linear - own.angular.cross(b.position);
  out.relative.angular = b.velocity.angular - own.angular;
  out.covariance = b.covariance;
  return out;
}

}  // namespace gannet::track
