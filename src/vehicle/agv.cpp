#include "src/vehicle/agv.hpp"

#include <algorithm>
#include <cmath>

namespace gannet::vehicle {

// The rate that can still be taken back to 0 by the wish is √(2·change·error), less what a cycle
// goes on for.
void JerkLimited::follow(double wish, const Limits& limits, double seconds) {
  if (seconds <= 0) return;
  const double error = wish - value_;
  const double step = limits.change * seconds;
  if (std::abs(error) <= step * seconds && std::abs(rate_) <= 2 * step) {
    value_ = wish;
    rate_ = 0;
    return;
  }
  const double half = step / 2;
  const double most = std::sqrt(half * half + 2 * limits.change * std::abs(error)) - half;
  const double wanted = std::copysign(std::min(most, limits.rate), error);
  rate_ += std::clamp(wanted - rate_, -step, step);
  value_ += rate_ * seconds;
}

Result<std::unique_ptr<Vehicle>> Agv::create(const AgvConfig& config) {
  if (!(config.wheel_radius_m > 0 && config.track_m > 0 && config.gear_ratio > 0))
    return Error{"vehicle.agv: wheel_radius_m, track_m and gear_ratio must be above 0"};
  if (!config.full_speed_rad_s.empty() && config.full_speed_rad_s.size() != 2)
    return Error{"vehicle.agv: needs 2 drives, the left wheel's and the right one's"};
  return std::unique_ptr<Vehicle>(new Agv(config));
}

Agv::Agv(const AgvConfig& config) : config_(config) {
  for (std::size_t i = 0; i < 2; ++i) {
    const double wheel = config.full_speed_rad_s.empty()
                             ? config.max_wheel_speed_rad_s
                             : config.full_speed_rad_s[i] / config.gear_ratio;
    full_speed_[i] = wheel * config.wheel_radius_m;
  }
}

void Agv::sense(std::span<const hal::DriveFeedback> feedback, TimePoint now) {
  is_sensed_ = feedback.size() >= 2;
  if (!is_sensed_) return;
  std::array<double, 2> rim;  // m/s
  for (std::size_t i = 0; i < 2; ++i) {
    const hal::DriveFeedback& wheel = feedback[i];
    const bool is_fresh = wheel.time != TimePoint{} &&
                          now - wheel.time <= from_seconds(config_.feedback_age_s) &&
                          std::isfinite(wheel.speed_rad_s);
    is_sensed_ = is_sensed_ && is_fresh;
    rim[i] = wheel.speed_rad_s / config_.gear_ratio * config_.wheel_radius_m;
  }
  if (!is_sensed_) return;
  sensed_speed_ = (rim[0] + rim[1]) / 2;
  sensed_turn_ = (rim[1] - rim[0]) / config_.track_m;
}

Reach Agv::update(const MotionWish& wish, Permit permit, Duration dt,
                  std::span<hal::DriveSetpoint> setpoints) {
  Reach reach;
  if (permit == Permit::kNone || setpoints.size() < 2) {
    // It goes on from the speed that it then has.
    speed_.set(own_velocity().linear.x());
    turn_.set(own_velocity().angular.z());
    if (!is_sensed_) reset();
    if (setpoints.size() >= 2) setpoints[0].value = setpoints[1].value = 0;
    return reach;
  }
  const bool follows = permit == Permit::kFull;
  const double least = config_.rear_free ? wish.velocity.linear.x() : 0.0;
  double speed = follows ? std::max(wish.velocity.linear.x(), least) : 0;
  double turn = follows ? wish.velocity.angular.z() : 0;
  const double rim = std::abs(speed) + std::abs(turn) * config_.track_m / 2;
  const double fastest = config_.max_wheel_speed_rad_s * config_.wheel_radius_m;
  if (rim > fastest) reach.scale = fastest / rim;
  speed *= reach.scale;
  turn *= reach.scale;
  const double seconds = to_seconds(dt);
  const double rate = follows
                          ? config_.max_acceleration_m_s2
                          : std::min(config_.hold_deceleration_m_s2, config_.max_acceleration_m_s2);
  speed_.follow(speed, {rate, config_.max_jerk_m_s3}, seconds);
  turn_.follow(turn, {config_.max_acceleration_rad_s2, config_.max_jerk_rad_s3}, seconds);
  if (!config_.rear_free && speed_.value() < 0) speed_.set(0);
  write(setpoints);
  return reach;
}

void Agv::write(std::span<hal::DriveSetpoint> setpoints) const {
  const double half = turn_.value() * config_.track_m / 2;
  setpoints[0].value = std::clamp((speed_.value() - half) / full_speed_[0], -1.0, 1.0);
  setpoints[1].value = std::clamp((speed_.value() + half) / full_speed_[1], -1.0, 1.0);
}

Twist<Body> Agv::own_velocity() const {
  Twist<Body> twist;
  twist.linear.x() = is_sensed_ ? sensed_speed_ : speed_.value();
  twist.angular.z() = is_sensed_ ? sensed_turn_ : turn_.value();
  return twist;
}

void Agv::reset() {
  speed_.set(0);
  turn_.set(0);
}

}  // namespace gannet::vehicle
