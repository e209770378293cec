#include "src/world/agv_plant.hpp"

#include <algorithm>
#include <cmath>

namespace gannet::world {
namespace {

constexpr double kGravity_m_s2 = 9.81;
constexpr double kStep_s = 0.0005;
constexpr double kCreep_m_s = 0.1;  // below it slip counts against this
constexpr double kMotorConstant_n_m_a = 0.1;

double sign_of(int wheel) { return wheel == 0 ? -1 : 1; }

}  // namespace

void AgvPlant::command(std::span<const double> throttles) {
  for (std::size_t i = 0; i < 2; ++i)
    wheels_[i].wanted_rad_s = i < throttles.size() ? speed_told(throttles[i]) : 0;
}

double AgvPlant::slip(int wheel) const {
  const auto i = static_cast<std::size_t>(wheel);
  const double rim = wheels_[i].speed_rad_s / config_.gear_ratio * config_.wheel_radius_m *
                     (1 + config_.radius_error[i]);
  const double ground = speed_m_s_ + sign_of(wheel) * turn_rad_s_ * track_m() / 2;
  return (rim - ground) / std::max({std::abs(rim), std::abs(ground), kCreep_m_s});
}

double AgvPlant::push(int wheel) const {
  const double load_n = config_.mass_kg * kGravity_m_s2 / 2;
  return config_.friction * load_n * std::clamp(slip(wheel) / config_.peak_slip, -1.0, 1.0);
}

MotorState AgvPlant::motor(int index) const {
  const Wheel& wheel = wheels_[static_cast<std::size_t>(index)];
  const double torque = push(index) * config_.wheel_radius_m / config_.gear_ratio;
  return {.speed_rad_s = wheel.speed_rad_s,
          .position_rad = wheel.position_rad,
          .current_a = std::abs(torque) / kMotorConstant_n_m_a};
}

Twist<Body> AgvPlant::velocity() const { return {{speed_m_s_, 0, 0}, {0, 0, turn_rad_s_}}; }

void AgvPlant::advance(double seconds) {
  const long steps = std::lround(seconds / kStep_s);
  for (long i = 0; i < steps; ++i) step(kStep_s);
}

void AgvPlant::step(double dt_s) {
  for (Wheel& wheel : wheels_) {
    // Exact for a command that stays, so that the step's length does not change the lag.
    wheel.speed_rad_s += (wheel.wanted_rad_s - wheel.speed_rad_s) *
                         (config_.motor_lag_s > 0 ? 1 - std::exp(-dt_s / config_.motor_lag_s) : 1);
    if (wheel.jammed) wheel.speed_rad_s = 0;
    wheel.position_rad += wheel.speed_rad_s * dt_s;
  }
  const double left = push(0), right = push(1);
  // Rolling resistance turns with the way and is no force at rest.
  const double rolls = config_.rolling_resistance * config_.mass_kg * kGravity_m_s2 *
                       std::clamp(speed_m_s_ / 0.01, -1.0, 1.0);
  speed_m_s_ += (left + right - rolls) / config_.mass_kg * dt_s;
  turn_rad_s_ += (right - left) * track_m() / 2 / config_.inertia_kg_m2 * dt_s;
  // Half the turn before the way, half after it: the midpoint's direction.
  const Eigen::Quaterniond half = quaternion_from_rpy(0, 0, turn_rad_s_ * dt_s / 2);
  const Eigen::Quaterniond middle = pose_.rotation * half;
  pose_.translation += middle * Eigen::Vector3d(speed_m_s_ * dt_s, 0, 0);
  pose_.rotation = (middle * half).normalized();
}

void describe(Visitor& v, AgvPlantConfig& c) {
  v.field("mass_kg", c.mass_kg, {.min = 0.1, .max = 1e5, .unit = "kg", .help = "Of all of it."});
  v.field("inertia_kg_m2", c.inertia_kg_m2,
          {.min = 1e-3, .max = 1e6, .unit = "kg·m²", .help = "About the upward axis."});
  v.field("wheel_radius_m", c.wheel_radius_m,
          {.min = 0.005, .max = 2, .unit = "m", .help = "As the daemon is told."});
  v.field("track_m", c.track_m,
          {.min = 0.02, .max = 10, .unit = "m", .help = "As the daemon is told."});
  v.field("gear_ratio", c.gear_ratio,
          {.min = 0.01, .max = 1000, .help = "Turns of the motor for one of the wheel."});
  v.field("motor_lag_s", c.motor_lag_s,
          {.min = 0, .max = 5, .unit = "s", .help = "Of a motor's speed after its command."});
  v.field("friction", c.friction,
          {.min = 0.01, .max = 2, .help = "Of the tyres on the floor, at most."});
  v.field("peak_slip", c.peak_slip,
          {.min = 0.01, .max = 1, .help = "Slip at which friction is all used."});
  v.field("rolling_resistance", c.rolling_resistance,
          {.min = 0, .max = 1, .help = "Part of the weight that holds it back."});
  v.field("radius_error", c.radius_error,
          {.min = -0.5,
           .max = 0.5,
           .size = 2,
           .help = "Part by which the left and the right wheel are larger than told."});
  v.field("track_error", c.track_error,
          {.min = -0.5, .max = 0.5, .help = "Part by which the track is wider than told."});
}

}  // namespace gannet::world
