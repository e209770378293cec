// Vehicle: from a wished motion to setpoints of its motors, and what it could not do of it.
// Kinds are listed in vehicle_kinds.cpp. Servo thread; RT safe after creation. The caller owns it.
#pragma once

#include <memory>
#include <span>

#include "hal/drive/drive_values.hpp"
#include "platform/base/result.hpp"
#include "platform/base/time.hpp"
#include "src/core/motion.hpp"
#include "src/core/permit.hpp"
#include "src/vehicle/vehicle_config.hpp"

namespace gannet::vehicle {

// What became of one cycle's wish. wished − reached is what the motors cannot do: axes that no
// motor acts on, limits and slew.
struct Reach {
  Wrench<Body> wished;       // by the velocity loop, on the controlled axes
  Wrench<Body> reached;      // what the setpoints make of it, on the controlled axes
  Wrench<Body> unreachable;  // the part of wished that no thrust can make, whatever its size
  double scale = 1;          // < 1: the rest was scaled down to the motors' limits
};

class Vehicle {
 public:
  virtual ~Vehicle() = default;

  virtual int motors() const = 0;  // 0: there is none, and nothing can be armed

  // What the drives say, a value for each motor in its order; once a cycle, before update. For
  // vehicles whose own motion is told by their drives.
  virtual void sense(std::span<const hal::DriveFeedback>, TimePoint) {}

  // One cycle: writes motors() setpoints. Permit none: all zero. Hold only: the wished velocity
  // counts as zero. setpoints shorter than motors(): nothing is written, permit none is assumed.
  virtual Reach update(const MotionWish& wish, Permit permit, Duration dt,
                       std::span<hal::DriveSetpoint> setpoints) = 0;

  // Own velocity against water or floor, as the setpoints written so far make it by the vehicle's
  // model or as its drives tell; zero on axes without control. For prediction over the images'
  // latency.
  virtual Twist<Body> own_velocity() const = 0;

  // Forgets integrals and the model's velocity.
  virtual void reset() = 0;
};

// A table without thrusters, an unknown axis and the like are errors. Start-up only.
Result<std::unique_ptr<Vehicle>> create_vehicle(const VehicleConfig& config);

}  // namespace gannet::vehicle
