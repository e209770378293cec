#include "src/world/arm_plant.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "src/vehicle/arm_rates.hpp"

namespace gannet::world {
namespace {

using vehicle::JointConfig;
using vehicle::Joints;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kStep_s = 0.001;

vehicle::ArmConfig arm_of(const ArmPlantConfig& config) {
  vehicle::ArmConfig arm;
  arm.robot = "custom";
  arm.joints = vehicle::pa10_joints();
  for (JointConfig& joint : arm.joints) {
    joint.a_m *= config.length_factor;
    joint.d_m *= config.length_factor;
  }
  return arm;
}

}  // namespace

void describe(Visitor& v, ArmPlantConfig& c) {
  v.field("lag_s", c.lag_s,
          {.min = 0, .max = 1, .unit = "s", .help = "Of each joint's speed, first order."});
  v.field("length_factor", c.length_factor,
          {.min = 0.5, .max = 2, .help = "The links' lengths against what the daemon is told."});
}

ArmPlant::ArmPlant(const ArmPlantConfig& config)
    : joints_(arm_of(config).joints),
      chain_(arm_of(config)),
      lag_s_(config.lag_s),
      angles_(chain_.size()),
      speeds_(Joints::Zero(chain_.size())),
      told_(Joints::Zero(chain_.size())),
      jammed_(joints_.size(), false) {
  for (int i = 0; i < chain_.size(); ++i)
    angles_[i] = joints_[static_cast<std::size_t>(i)].rest_deg * kDegree;
  const Transform<vehicle::ArmBase, Body> rest = chain_.base_from_body(angles_);
  world_from_base_ = Transform<World, Body>::identity() * rest.inverse();
  settle();
}

void ArmPlant::settle() { pose_ = world_from_base_ * chain_.base_from_body(angles_); }

void ArmPlant::command(std::span<const double> throttles) {
  for (int i = 0; i < chain_.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    told_[i] = k < throttles.size() ? speed_told(throttles[k]) / kArmGear : 0;
  }
}

void ArmPlant::advance(double seconds) {
  const auto steps = static_cast<int>(std::lround(seconds / kStep_s));
  const double share = lag_s_ > 0 ? 1 - std::exp(-kStep_s / lag_s_) : 1;
  for (int step = 0; step < steps; ++step) {
    for (int i = 0; i < chain_.size(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      speeds_[i] += share * (told_[i] - speeds_[i]);
      if (jammed_[k]) speeds_[i] = 0;
      const double wanted = angles_[i] + speeds_[i] * kStep_s;
      angles_[i] = std::clamp(wanted, joints_[k].min_deg * kDegree, joints_[k].max_deg * kDegree);
      if (angles_[i] != wanted) speeds_[i] = 0;
    }
  }
  settle();
}

MotorState ArmPlant::motor(int index) const {
  return {.speed_rad_s = speeds_[index] * kArmGear, .position_rad = angles_[index] * kArmGear};
}

// Newton's steps by the same damped inverse that steers the arm: from rest, away from
// singularities, a few do.
void ArmPlant::set_pose(const Transform<World, Body>& pose) {
  vehicle::JointBounds bounds = {angles_, angles_};
  for (int step = 0; step < 50; ++step) {
    const Transform<Body, Body> off = pose_.inverse() * pose;
    Vector6d twist;
    twist << off.translation, rotation_vector_from_quaternion(off.rotation);
    if (twist.norm() < 1e-12) break;
    for (int i = 0; i < chain_.size(); ++i) {
      const JointConfig& joint = joints_[static_cast<std::size_t>(i)];
      bounds.least[i] = joint.min_deg * kDegree - angles_[i];
      bounds.most[i] = joint.max_deg * kDegree - angles_[i];
    }
    angles_ += vehicle::joint_rates(chain_.jacobian(angles_), twist, Joints::Zero(chain_.size()),
                                    bounds, {});
    settle();
  }
  speeds_.setZero();
}

Twist<Body> ArmPlant::velocity() const {
  const Vector6d twist = chain_.jacobian(angles_) * speeds_;
  return {twist.head<3>(), twist.tail<3>()};
}

}  // namespace gannet::world
