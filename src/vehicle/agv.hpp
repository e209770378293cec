// Agv: two driven wheels on one line (differential drive), motor 1 the left one, motor 2 the right
// one, seen in the sense of driving forward. Of a wish it can do speed ahead v and turn ω about its
// upward axis; wheels r·ω_l = v − ω·b/2, r·ω_r = v + ω·b/2 (R. Siegwart et al., "Introduction to
// Autonomous Mobile Robots", 2011, §3.2). Too fast a wish is scaled down, so that its curve stays;
// v and ω then follow within their limits of acceleration and jerk. It never drives backwards but
// with a free rear. The drives close the loops of speed. Own motion is what the wheels report.
// Servo thread; RT safe after creation.
#pragma once

#include <array>

#include "src/vehicle/vehicle.hpp"

namespace gannet::vehicle {

// A value that follows a wish within limits of its first and second derivative. RT safe.
class JerkLimited {
 public:
  struct Limits {
    double rate = 1;    // of the value, per s
    double change = 1;  // of the rate, per s
  };
  void follow(double wish, const Limits& limits, double seconds);
  void set(double value) { value_ = value, rate_ = 0; }
  double value() const { return value_; }
  double rate() const { return rate_; }

 private:
  double value_ = 0, rate_ = 0;
};

class Agv final : public Vehicle {
 public:
  static Result<std::unique_ptr<Vehicle>> create(const AgvConfig& config);

  int motors() const override { return 2; }
  void sense(std::span<const hal::DriveFeedback> feedback, TimePoint now) override;
  // Reach has no wrench for wheels; scale is the share of the wished twist that the wheels' speed
  // allows.
  Reach update(const MotionWish& wish, Permit permit, Duration dt,
               std::span<hal::DriveSetpoint> setpoints) override;
  Twist<Body> own_velocity() const override;  // of the wheels; as commanded where they say nothing
  void reset() override;

 private:
  explicit Agv(const AgvConfig& config);
  void write(std::span<hal::DriveSetpoint> setpoints) const;

  const AgvConfig config_;
  std::array<double, 2> full_speed_;  // m/s of a wheel's rim at setpoint 1
  JerkLimited speed_, turn_;          // m/s, rad/s
  bool is_sensed_ = false;
  double sensed_speed_ = 0, sensed_turn_ = 0;
};

}  // namespace gannet::vehicle
