// Plant: the body of a simulated vehicle with its motors, whatever it is: throttles and time in,
// pose, velocity and what the motors do out. Kinds by vehicle.kind of the scenario, in
// plant_kinds.cpp. A plant moves in fixed steps, so that runs repeat bit for bit.
// World's thread alone.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "src/core/motion.hpp"
#include "src/core/transform.hpp"

namespace gannet::world {

struct VehicleScenario;

struct MotorState {  // of the shaft that the drive speaks of, by the vehicle's sign
  double speed_rad_s = 0;
  double position_rad = 0;  // over all turns
  double current_a = 0;
};

class Plant {
 public:
  virtual ~Plant() = default;

  virtual int motors() const = 0;
  // Throttles −1 … 1, one a motor, for the time from now on; missing ones are 0. A node that is
  // told a speed gives throttle_at_speed of thruster.hpp, and speed_told takes it back exactly.
  virtual void command(std::span<const double> throttles) = 0;
  virtual void advance(double seconds) = 0;
  virtual MotorState motor(int index) const = 0;
  virtual void jam(int index, bool jammed) = 0;  // a jammed one stands still whatever is commanded

  virtual void set_pose(const Transform<World, Body>& pose) = 0;
  virtual const Transform<World, Body>& pose() const = 0;
  virtual Twist<Body> velocity() const = 0;
  virtual void set_current(const Eigen::Vector3d&) {}  // of the water, m/s in the world's axes
};

double speed_told(double throttle);  // rad/s

// Never null: without a vehicle, a body that stays where it is put. Start-up only.
std::unique_ptr<Plant> make_plant(const VehicleScenario& vehicle);

}  // namespace gannet::world
