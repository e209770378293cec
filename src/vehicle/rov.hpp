// Rov: an underwater vehicle with thrusters. A velocity loop (PI with feed-forward of drag and of
// the wish's smoothed acceleration, gains in 1/s times mass with added mass) wishes a wrench;
// Allocation makes thrusts of it; the slew limit moves all thrusts together; the curves make
// commands. The integral grows on an axis only while the motors reach what is wished there, so it
// does not wind up. Without a measured velocity the model's own one stands in, and the integral
// rests. The model of its own motion: M·v̇ = τ − D₁·v − D₂·|v|·v per controlled axis, with
// first-order thruster lag; Coriolis and restoring forces are left to the pose filter, which sees
// their effect. Servo thread; RT safe after creation.
#pragma once

#include <vector>

#include "src/vehicle/allocation.hpp"
#include "src/vehicle/vehicle.hpp"

namespace gannet::vehicle {

class Rov final : public Vehicle {
 public:
  static Result<std::unique_ptr<Vehicle>> create(const RovConfig& config);

  int motors() const override { return allocation_.size(); }
  Reach update(const MotionWish& wish, Permit permit, Duration dt,
               std::span<hal::DriveSetpoint> setpoints) override;
  Twist<Body> own_velocity() const override;
  void reset() override;

 private:
  struct Plant {                                         // per axis x, y, z, roll, pitch, yaw
    Vector6d mass, linear_drag, quadratic_drag, steady;  // steady: buoyancy
    double lag_s = 0;
  };
  struct Gains {
    Vector6d proportional, integral;  // 1/s, 1/s²
    double slew_n_s = 0;
    double smoothing_s = 0;
  };
  Rov(const RovConfig& config, const Allocation& allocation, const Allocation::Axes& controlled,
      std::vector<CurveConfig> curves);

  Vector6d drag(const Vector6d& velocity) const;
  Vector6d error_of(const MotionWish& wish, const Vector6d& velocity) const;
  Vector6d acceleration(const Vector6d& velocity, Permit permit, double seconds);
  void slew(const Allocation::Thrusts& wanted, double seconds);
  void integrate(const Vector6d& error, const Vector6d& undone, double seconds);
  void advance_model(double seconds);
  void stop(std::span<hal::DriveSetpoint> setpoints, double seconds);

  Plant plant_;
  Gains gains_;
  Allocation allocation_;
  Vector6d controlled_;  // 1 or 0
  std::vector<CurveConfig> curves_;
  Allocation::Thrusts thrusts_;
  Vector6d integral_ = Vector6d::Zero();  // N, N·m
  Vector6d smooth_ = Vector6d::Zero();    // the wish, low-passed
  Allocation::Thrusts rotors_;            // √N, signed: the model's rotor speeds
  bool stopped_ = true;                   // no permit in the newest cycle
  Vector6d model_velocity_ = Vector6d::Zero();
};

}  // namespace gannet::vehicle
