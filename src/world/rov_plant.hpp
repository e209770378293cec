// RovPlant: a rigid body in water with thrusters (Fossen, Handbook of Marine Craft Hydrodynamics
// and Motion Control, 2011, ch. 6–8), in axes of REP-103 (x forward, y left, z up):
//   M_RB ν̇ + C_RB(ν)ν + M_A ν̇_r + C_A(ν_r)ν_r + D(ν_r)ν_r = g(η) + τ,   ν_r = ν − ν_current
// ν = (linear m/s, angular rad/s) in the body's frame; the current is steady in the world's frame
// and does not turn. Integrated by RK4 in fixed steps of 1 ms, so that runs repeat bit for bit.
//
// The defaults are the BlueROV2 Heavy: mass, inertia, volume, centres, added mass and drag from
// von Benzon et al., "An Open-Source Benchmark Simulator: Control of a BlueROV2 Underwater Robot",
// J. Mar. Sci. Eng. 2022, 10(12), 1898 (axes turned from z down to z up); thrusters' places and
// directions from the same paper's allocation matrix in ArduSub's order ("vectored_6dof").
// Any thread.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "platform/base/describe.hpp"
#include "src/core/motion.hpp"
#include "src/core/pose_estimate.hpp"
#include "src/core/transform.hpp"
#include "src/world/plant.hpp"
#include "src/world/thruster.hpp"

namespace gannet::world {

struct ThrusterPlace {
  std::vector<double> position_m;
  std::vector<double> direction;  // of the thrust for positive throttle; any length but 0
};

struct RovPlantConfig {
  double mass_kg = 13.5;
  double volume_m3 = 0.0134;
  double water_density_kg_m3 = 1000;
  std::vector<double> inertia_kg_m2 = {0.26, 0.23, 0.37};
  std::vector<double> centre_of_gravity_m = {0, 0, 0};
  std::vector<double> centre_of_buoyancy_m = {0, 0, 0.01};
  std::vector<double> added_mass = {6.36, 7.12, 18.68, 0.189, 0.135, 0.222};
  std::vector<double> linear_drag = {13.7, 0, 33.0, 0, 0.8, 0};
  std::vector<double> quadratic_drag = {141, 217, 190, 1.19, 0.47, 1.5};
  std::vector<ThrusterPlace> thrusters;  // empty: the eight of vectored_6dof
};

void describe(Visitor& v, ThrusterPlace& c);
void describe(Visitor& v, RovPlantConfig& c);

std::vector<ThrusterPlace> vectored_6dof_thrusters();

class RovPlant final : public Plant {
 public:
  explicit RovPlant(const RovPlantConfig& config);

  int motors() const override { return static_cast<int>(thrusters_.size()); }
  void command(std::span<const double> throttles) override;
  void advance(double seconds) override;  // in steps of 1 ms, rounded to the nearest number of them
  MotorState motor(int index) const override;
  void jam(int index, bool jammed) override;

  void set_pose(const Transform<World, Body>& pose) override { state_.pose = pose; }
  void set_velocity(const Vector6d& velocity) { state_.velocity = velocity; }
  void set_current(const Eigen::Vector3d& world_m_s) override { current_ = world_m_s; }

  const Transform<World, Body>& pose() const override { return state_.pose; }
  Twist<Body> velocity() const override;
  const std::vector<Thruster>& thrusters() const { return thrusters_; }

  const Matrix6d& rigid_mass() const { return rigid_mass_; }
  const Matrix6d& added_mass() const { return added_mass_; }
  double kinetic_energy_j() const;  // of body and added mass, current 0
  Vector6d thrust() const;          // (force N, torque N·m) on the body by its thrusters
  // The force of gravity and buoyancy at an attitude.
  Vector6d restoring(const Eigen::Quaterniond& world_from_body) const;

 private:
  struct State {
    Transform<World, Body> pose;
    Vector6d velocity = Vector6d::Zero();
  };
  struct Rate {
    Eigen::Vector3d position;
    Eigen::Vector4d rotation;  // x, y, z, w of the quaternion's derivative
    Vector6d velocity;
  };
  Rate rate(const State& state, const Vector6d& thrust) const;
  static State moved(const State& state, const Rate& rate, double dt_s);
  void step(double dt_s);

  RovPlantConfig config_;
  Matrix6d rigid_mass_;
  Matrix6d added_mass_;
  Matrix6d inverse_mass_;
  Vector6d linear_drag_;
  Vector6d quadratic_drag_;
  std::vector<Vector6d> wrench_per_newton_;
  std::vector<Thruster> thrusters_;
  Eigen::Vector3d current_ = Eigen::Vector3d::Zero();
  State state_;
};

}  // namespace gannet::world
