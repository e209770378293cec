// Thruster: one Blue Robotics T200 on its ESC: throttle → speed of the rotor (first-order lag) →
// thrust. Throttle −1 … 1 is the ESC's pulse, (width − 1500 µs) / 400 µs.
// Any thread; deterministic.
//
// Sources, fixed before anything was tuned: Blue Robotics, "T200 Public Performance Data 10–20 V,
// September 2019", sheet 16 V (bollard thrust; its dead band is 1472 … 1528 µs). The lag of 0.2 s
// in the rotor's speed is that of the public UUV Simulator model of the BlueROV2 (HKPolyU-UAV).
#pragma once

namespace gannet::world {

inline constexpr double kThrusterLag_s = 0.2;

double steady_speed_rad_s(double throttle);  // signed, of the rotor; 0 in the dead band
// The throttle at which it settles at this speed.
double throttle_at_speed(double speed_rad_s);
double thrust_at_speed_n(double speed_rad_s);  // signed; odd in neither direction

class Thruster {
 public:
  void command(double throttle);  // clamped to [−1, 1]; a NaN is 0
  void advance(double dt_s);
  // A jammed rotor stands still whatever is commanded.
  void jam(bool jammed) { jammed_ = jammed; }

  double throttle() const { return throttle_; }
  double speed_rad_s() const { return speed_rad_s_; }
  double position_rad() const { return position_rad_; }  // over all turns
  double thrust_n() const { return thrust_at_speed_n(speed_rad_s_); }
  double current_a() const;

 private:
  double throttle_ = 0;
  double speed_rad_s_ = 0;
  double position_rad_ = 0;
  bool jammed_ = false;
};

}  // namespace gannet::world
