#include "src/vehicle/arm.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace gannet::vehicle {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kBraking = 0.5;  // share of the acceleration that braking before a limit counts on
constexpr double kReturn_1_s = 1;  // of the way, from beyond a limit

Result<void> check_joint(const JointConfig& joint, std::size_t i, double margin_deg) {
  const std::string name = "vehicle.arm.joint[" + std::to_string(i) + "]";
  if (!(joint.max_deg - joint.min_deg > 2 * margin_deg))
    return Error{name + ".max_deg: leaves no room above min_deg within limit_margin_deg"};
  if (!(joint.rest_deg >= joint.min_deg + margin_deg &&
        joint.rest_deg <= joint.max_deg - margin_deg))
    return Error{name + ".rest_deg: is not between min_deg and max_deg within limit_margin_deg"};
  if (!(joint.max_speed_deg_s > 0 && joint.max_acceleration_deg_s2 > 0 && joint.gear_ratio > 0))
    return Error{name + ": speed, acceleration and gear_ratio must be positive"};
  return {};
}

Result<void> check(const ArmConfig& c) {
  const std::vector<JointConfig> joints = joints_of(c);
  if (joints.empty() || joints.size() > kMaxJoints)
    return Error{"vehicle.arm.joint: 1 to " + std::to_string(kMaxJoints) + " tables are needed"};
  if (c.body_position_m.size() != 3 || c.body_turn_deg.size() != 3)
    return Error{"vehicle.arm: body_position_m and body_turn_deg need three numbers each"};
  if (!c.full_speed_rad_s.empty() && c.full_speed_rad_s.size() != joints.size())
    return Error{"drive.motor: one table is needed for each joint"};
  for (std::size_t i = 0; i < joints.size(); ++i)
    if (const auto checked = check_joint(joints[i], i, c.limit_margin_deg); !checked)
      return checked.error();
  return {};
}

}  // namespace

Result<std::unique_ptr<Vehicle>> Arm::create(const ArmConfig& config) {
  if (const auto checked = check(config); !checked) return checked.error();
  return std::unique_ptr<Vehicle>(new Arm(config));
}

Arm::Arm(const ArmConfig& c)
    : chain_(c),
      damping_{c.radian_as_m, c.singular_below_m, c.damping_m},
      posture_gain_(c.posture_gain),
      feedback_age_(from_seconds(c.feedback_age_s)),
      jacobian_(Jacobian::Zero(6, chain_.size())) {
  for (Joints* values : {&limits_.min, &limits_.max, &limits_.speed, &limits_.acceleration, &zero_,
                         &gear_, &full_speed_, &rest_, &angles_, &speeds_, &commanded_})
    values->setZero(chain_.size());
  const std::vector<JointConfig> joints = joints_of(c);
  for (int i = 0; i < chain_.size(); ++i) {
    const JointConfig& joint = joints[static_cast<std::size_t>(i)];
    gear_[i] = joint.gear_ratio;
    zero_[i] = joint.zero_deg * kDegree;
    rest_[i] = joint.rest_deg * kDegree;
    limits_.min[i] = (joint.min_deg + c.limit_margin_deg) * kDegree;
    limits_.max[i] = (joint.max_deg - c.limit_margin_deg) * kDegree;
    limits_.acceleration[i] = joint.max_acceleration_deg_s2 * kDegree;
    limits_.speed[i] = joint.max_speed_deg_s * kDegree;
    full_speed_[i] = c.full_speed_rad_s.empty() ? limits_.speed[i] * gear_[i]
                                                : c.full_speed_rad_s[static_cast<std::size_t>(i)];
    limits_.speed[i] = std::min(limits_.speed[i], full_speed_[i] / gear_[i]);
  }
}

void Arm::sense(std::span<const hal::DriveFeedback> feedback, TimePoint now) {
  is_sensed_ = feedback.size() >= static_cast<std::size_t>(chain_.size());
  for (int i = 0; i < chain_.size() && is_sensed_; ++i) {
    const hal::DriveFeedback& told = feedback[static_cast<std::size_t>(i)];
    is_sensed_ = told.time != TimePoint{} && now - told.time <= feedback_age_ &&
                 std::isfinite(told.position_rad) && std::isfinite(told.speed_rad_s);
    angles_[i] = told.position_rad / gear_[i] + zero_[i];
    speeds_[i] = told.speed_rad_s / gear_[i];
  }
  if (is_sensed_) jacobian_ = chain_.jacobian(angles_);
}

// What the limits of angle say goes before what the acceleration allows.
JointBounds Arm::bounds(double seconds) const {
  JointBounds bounds = {Joints(chain_.size()), Joints(chain_.size())};
  for (int i = 0; i < chain_.size(); ++i) {
    const double speed = limits_.speed[i], step = limits_.acceleration[i] * seconds;
    const auto towards = [&](double room) {
      if (room < 0) return std::max(kReturn_1_s * room, -speed);
      return std::min(speed, std::sqrt(2 * kBraking * limits_.acceleration[i] * room));
    };
    const double most = towards(limits_.max[i] - angles_[i]);
    const double least = -towards(angles_[i] - limits_.min[i]);
    bounds.most[i] = std::clamp(commanded_[i] + step, least, most);
    bounds.least[i] = std::clamp(commanded_[i] - step, least, most);
  }
  return bounds;
}

Reach Arm::stop(std::span<hal::DriveSetpoint> setpoints) {
  for (auto& setpoint : setpoints) setpoint.value = 0;
  commanded_.setZero();
  Reach reach;
  reach.scale = 0;
  return reach;
}

Reach Arm::update(const MotionWish& wish, Permit permit, Duration dt,
                  std::span<hal::DriveSetpoint> setpoints) {
  Vector6d twist;
  twist << wish.velocity.linear, wish.velocity.angular;
  if (permit == Permit::kNone || !is_sensed_ || !twist.allFinite() ||
      setpoints.size() < static_cast<std::size_t>(chain_.size()))
    return stop(setpoints);
  const JointBounds allowed = bounds(std::clamp(to_seconds(dt), 0.0, 0.1));
  Joints posture = posture_gain_ * (rest_ - angles_);
  if (permit == Permit::kHoldOnly) {
    twist.setZero();
    posture.setZero();
  }
  commanded_ = joint_rates(jacobian_, twist, posture, allowed, damping_);
  for (int i = 0; i < chain_.size(); ++i)
    setpoints[static_cast<std::size_t>(i)].value = commanded_[i] * gear_[i] / full_speed_[i];
  Reach reach;
  const double wished = twist.squaredNorm();
  if (wished > 0) reach.scale = std::clamp(twist.dot(jacobian_ * commanded_) / wished, 0.0, 1.0);
  return reach;
}

Twist<Body> Arm::own_velocity() const {
  if (!is_sensed_) return {};
  const Vector6d twist = jacobian_ * speeds_;
  return {twist.head<3>(), twist.tail<3>()};
}

}  // namespace gannet::vehicle
