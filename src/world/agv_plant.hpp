// AgvPlant: a carrier on two driven wheels and castors, on a level floor. Each motor's speed
// follows its command with a first-order lag; tyres push by their slip, up to what friction allows:
//   F_i = μ·N_i·clamp(s_i / s_peak, −1, 1),  s_i = (r_i·ω_i − v_i) / max(|r_i·ω_i|, |v_i|, 0.1 m/s)
//   m·v̇ = F_l + F_r − c_r·m·g·sign(v),  I·ψ̈ = (F_r − F_l)·b/2
// (J. Y. Wong, "Theory of Ground Vehicles", 4th ed., 2008, §1.3: force in proportion to slip up to
// 15–20 %, then friction; c_r of solid rubber on a hard floor about 0.015.) Each wheel's radius and
// the track differ from what the daemon was told, the systematic errors of odometry (J. Borenstein,
// L. Feng, "Measurement and correction of systematic odometry errors in mobile robots", IEEE Trans.
// Robotics and Automation 12(6), 1996). Mass, μ and lag are assumed: a carrier of 50 kg, rubber on
// a smooth floor, a loop of speed with 0.1 s; scenarios vary them. Steps of 0.5 ms. World's thread
// alone.
#pragma once

#include <array>
#include <vector>

#include "platform/base/describe.hpp"
#include "src/world/plant.hpp"

namespace gannet::world {

struct AgvPlantConfig {
  double mass_kg = 50;
  double inertia_kg_m2 = 4;  // about the upward axis
  double wheel_radius_m = 0.1;
  double track_m = 0.5;
  double gear_ratio = 15;
  double motor_lag_s = 0.1;
  double friction = 0.7;
  double peak_slip = 0.15;
  double rolling_resistance = 0.015;
  std::vector<double> radius_error = {0.004, -0.003};  // parts of it, left and right
  double track_error = 0.01;
};

void describe(Visitor& v, AgvPlantConfig& c);

class AgvPlant final : public Plant {
 public:
  explicit AgvPlant(const AgvPlantConfig& config) : config_(config) {}

  int motors() const override { return 2; }  // left, right
  void command(std::span<const double> throttles) override;
  void advance(double seconds) override;
  MotorState motor(int index) const override;
  void jam(int index, bool jammed) override { at(index).jammed = jammed; }

  void set_pose(const Transform<World, Body>& pose) override { pose_ = pose; }
  const Transform<World, Body>& pose() const override { return pose_; }
  Twist<Body> velocity() const override;
  double slip(int wheel) const;  // −1 … 1

 private:
  struct Wheel {
    double wanted_rad_s = 0;  // of the motor's shaft, as all here
    double speed_rad_s = 0;
    double position_rad = 0;
    bool jammed = false;
  };
  Wheel& at(int index) { return wheels_[static_cast<std::size_t>(index)]; }
  double track_m() const { return config_.track_m * (1 + config_.track_error); }
  double push(int wheel) const;  // N
  void step(double dt_s);

  const AgvPlantConfig config_;
  std::array<Wheel, 2> wheels_;
  double speed_m_s_ = 0;
  double turn_rad_s_ = 0;
  Transform<World, Body> pose_;
};

}  // namespace gannet::world
