#include "src/world/rov_plant.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <cstddef>

namespace gannet::world {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kGravity_m_s2 = 9.81;
constexpr double kStep_s = 0.001;

Vector3d vector3(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }
Vector6d vector6(const std::vector<double>& v) { return Vector6d(v.data()); }

Matrix3d cross(const Vector3d& v) {
  Matrix3d s;
  s << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return s;
}

// Fossen Eq. 3.60: the parametrisation of C from M that is skew-symmetric, so that it does no work.
Vector6d coriolis(const Matrix6d& mass, const Vector6d& velocity) {
  const Vector6d momentum = mass * velocity;
  const Vector3d linear = velocity.head<3>();
  const Vector3d angular = velocity.tail<3>();
  Vector6d force;
  force << angular.cross(momentum.head<3>()),
      linear.cross(momentum.head<3>()) + angular.cross(momentum.tail<3>());
  return force;
}

Matrix6d rigid_mass_of(const RovPlantConfig& c) {
  const Vector3d centre = vector3(c.centre_of_gravity_m);
  const Matrix3d s = cross(centre);
  Matrix6d mass = Matrix6d::Zero();
  mass.topLeftCorner<3, 3>() = c.mass_kg * Matrix3d::Identity();
  mass.topRightCorner<3, 3>() = -c.mass_kg * s;
  mass.bottomLeftCorner<3, 3>() = c.mass_kg * s;
  mass.bottomRightCorner<3, 3>() =
      Matrix3d(vector3(c.inertia_kg_m2).asDiagonal()) - c.mass_kg * s * s;
  return mass;
}

}  // namespace

std::vector<ThrusterPlace> vectored_6dof_thrusters() {
  constexpr double x = 0.156, y = 0.111;    // of the slanted ones
  constexpr double vx = 0.120, vy = 0.218;  // of the upright ones
  return {{{x, -y, 0}, {-1, -1, 0}},   {{x, y, 0}, {-1, 1, 0}},    {{-x, -y, 0}, {1, -1, 0}},
          {{-x, y, 0}, {1, 1, 0}},     {{vx, -vy, 0}, {0, 0, -1}}, {{vx, vy, 0}, {0, 0, -1}},
          {{-vx, -vy, 0}, {0, 0, -1}}, {{-vx, vy, 0}, {0, 0, -1}}};
}

RovPlant::RovPlant(const RovPlantConfig& config)
    : config_(config),
      rigid_mass_(rigid_mass_of(config)),
      added_mass_(vector6(config.added_mass).asDiagonal()),
      inverse_mass_((rigid_mass_ + added_mass_).inverse()),
      linear_drag_(vector6(config.linear_drag)),
      quadratic_drag_(vector6(config.quadratic_drag)) {
  if (config_.thrusters.empty()) config_.thrusters = vectored_6dof_thrusters();
  for (const ThrusterPlace& place : config_.thrusters) {
    const Vector3d direction = vector3(place.direction).normalized();
    Vector6d wrench;
    wrench << direction, vector3(place.position_m).cross(direction);
    wrench_per_newton_.push_back(wrench);
  }
  thrusters_.resize(config_.thrusters.size());
}

void RovPlant::command(std::span<const double> throttles) {
  for (std::size_t i = 0; i < thrusters_.size(); ++i)
    thrusters_[i].command(i < throttles.size() ? throttles[i] : 0);
}

MotorState RovPlant::motor(int index) const {
  const Thruster& thruster = thrusters_[static_cast<std::size_t>(index)];
  return {.speed_rad_s = thruster.speed_rad_s(),
          .position_rad = thruster.position_rad(),
          .current_a = thruster.current_a()};
}

void RovPlant::jam(int index, bool jammed) {
  thrusters_[static_cast<std::size_t>(index)].jam(jammed);
}

void RovPlant::advance(double seconds) {
  const long steps = std::lround(seconds / kStep_s);
  for (long i = 0; i < steps; ++i) step(kStep_s);
}

Twist<Body> RovPlant::velocity() const {
  return {state_.velocity.head<3>(), state_.velocity.tail<3>()};
}

double RovPlant::kinetic_energy_j() const {
  return 0.5 * state_.velocity.dot((rigid_mass_ + added_mass_) * state_.velocity);
}

Vector6d RovPlant::thrust() const {
  Vector6d total = Vector6d::Zero();
  for (std::size_t i = 0; i < thrusters_.size(); ++i)
    total += wrench_per_newton_[i] * thrusters_[i].thrust_n();
  return total;
}

Vector6d RovPlant::restoring(const Quaterniond& world_from_body) const {
  const Vector3d up = world_from_body.conjugate() * Vector3d::UnitZ();
  const Vector3d weight = -config_.mass_kg * kGravity_m_s2 * up;
  const Vector3d buoyancy = config_.water_density_kg_m3 * config_.volume_m3 * kGravity_m_s2 * up;
  Vector6d force;
  force << weight + buoyancy, vector3(config_.centre_of_gravity_m).cross(weight) +
                                  vector3(config_.centre_of_buoyancy_m).cross(buoyancy);
  return force;
}

RovPlant::Rate RovPlant::rate(const State& state, const Vector6d& thrust) const {
  const Quaterniond& q = state.pose.rotation;
  const Vector3d angular = state.velocity.tail<3>();
  const Vector3d current = q.conjugate() * current_;
  Vector6d relative = state.velocity;
  relative.head<3>() -= current;
  Vector6d current_rate = Vector6d::Zero();  // a steady current turns as the body sees it
  current_rate.head<3>() = -angular.cross(current);
  const Vector6d drag =
      (linear_drag_.array() + quadratic_drag_.array() * relative.array().abs()) * relative.array();

  Rate rate;
  rate.position = q * Vector3d(state.velocity.head<3>());
  rate.rotation = 0.5 * (q * Quaterniond(0, angular.x(), angular.y(), angular.z())).coeffs();
  rate.velocity =
      inverse_mass_ * (thrust + restoring(q) - coriolis(rigid_mass_, state.velocity) -
                       coriolis(added_mass_, relative) - drag + added_mass_ * current_rate);
  return rate;
}

RovPlant::State RovPlant::moved(const State& state, const Rate& rate, double dt_s) {
  State moved;
  moved.pose.translation = state.pose.translation + dt_s * rate.position;
  moved.pose.rotation.coeffs() = state.pose.rotation.coeffs() + dt_s * rate.rotation;
  moved.pose.rotation.normalize();
  moved.velocity = state.velocity + dt_s * rate.velocity;
  return moved;
}

void RovPlant::step(double dt_s) {
  for (Thruster& thruster : thrusters_) thruster.advance(dt_s);
  const Vector6d force = thrust();
  const Rate a = rate(state_, force);
  const Rate b = rate(moved(state_, a, dt_s / 2), force);
  const Rate c = rate(moved(state_, b, dt_s / 2), force);
  const Rate d = rate(moved(state_, c, dt_s), force);
  const Rate mean{(a.position + 2 * b.position + 2 * c.position + d.position) / 6,
                  (a.rotation + 2 * b.rotation + 2 * c.rotation + d.rotation) / 6,
                  (a.velocity + 2 * b.velocity + 2 * c.velocity + d.velocity) / 6};
  state_ = moved(state_, mean, dt_s);
}

void describe(Visitor& v, ThrusterPlace& c) {
  v.field("position_m", c.position_m,
          {.size = 3, .unit = "m", .help = "Where it pushes, in the body's frame."});
  v.field("direction", c.direction,
          {.size = 3, .help = "Where it pushes to with positive throttle; any length."});
}

void describe(Visitor& v, RovPlantConfig& c) {
  v.field("mass_kg", c.mass_kg, {.min = 0.1, .max = 1e5, .unit = "kg", .help = "Mass in air."});
  v.field("volume_m3", c.volume_m3,
          {.min = 0, .max = 100, .unit = "m³", .help = "Displaced volume."});
  v.field("water_density_kg_m3", c.water_density_kg_m3,
          {.min = 900, .max = 1100, .unit = "kg/m³", .help = "Density of the water."});
  v.field("inertia_kg_m2", c.inertia_kg_m2,
          {.min = 1e-6, .size = 3, .unit = "kg·m²", .help = "About the centre of gravity."});
  v.field("centre_of_gravity_m", c.centre_of_gravity_m,
          {.size = 3, .unit = "m", .help = "In the body's frame."});
  v.field("centre_of_buoyancy_m", c.centre_of_buoyancy_m,
          {.size = 3, .unit = "m", .help = "In the body's frame."});
  v.field("added_mass", c.added_mass,
          {.min = 0,
           .size = 6,
           .unit = "kg, kg·m²",
           .help = "Of surge, sway, heave, roll, pitch, yaw."});
  v.field("linear_drag", c.linear_drag,
          {.min = 0, .size = 6, .unit = "N·s/m, N·m·s", .help = "Of the same six."});
  v.field("quadratic_drag", c.quadratic_drag,
          {.min = 0, .size = 6, .unit = "N·s²/m², N·m·s²", .help = "Of the same six."});
  v.list("thruster", c.thrusters, "A thruster each; none: the eight of ArduSub's vectored_6dof.");
}

}  // namespace gannet::world
