// The vehicle as data, described once. Defaults are a BlueROV2 with T200 thrusters at 16 V:
//  - mass, added mass and drag: C.-J. Wu, "6-DoF Modelling and Control of a Remotely Operated
//    Vehicle", Flinders University 2018, Tables 5.1–5.3; M. von Benzon et al., "An Open-Source
//    Benchmark Simulator: Control of a BlueROV2 Underwater Robot", J. Mar. Sci. Eng. 2022, 10,
//    1898 reports its own set for the Heavy frame;
//  - thrust curve: Blue Robotics, T200 public performance data 10–20 V, September 2019: at 16 V
//    51.4 N forward, 39.9 N backward, no thrust within 1472–1528 µs of 1500 ± 400 µs.
//  - lag of 0.2 s: the UUV Simulator's public BlueROV2 model. Too much of it costs little, too
//    little makes the loop swing.
// Start-up only.
#pragma once

#include <string>
#include <vector>

#include "platform/base/describe.hpp"
#include "src/vehicle/agv_config.hpp"
#include "src/vehicle/arm_config.hpp"

namespace gannet::vehicle {

// Thrust = maximum · ((|command| − dead_band) / (1 − dead_band))^exponent beyond the dead band.
struct CurveConfig {
  double max_forward_n = 51.4;   // at command 1
  double max_backward_n = 39.9;  // at command −1
  double dead_band = 0.07;       // commands up to this make no thrust
  double exponent = 1.33;        // fits the published points within 2 %
  double limit = 1.0;            // largest command used
};

struct ThrusterConfig {
  std::vector<double> position_m = {0, 0, 0};  // body axes, from the centre of mass
  std::vector<double> direction = {1, 0, 0};   // of the force on the body at positive command
  CurveConfig curve;
};

struct RovConfig {
  std::string frame = "vectored";  // vectored | vectored_6dof | custom
  std::vector<std::string> controlled = {"x", "y", "z", "yaw"};
  CurveConfig curve;                      // of every thruster of a named frame
  std::vector<ThrusterConfig> thrusters;  // custom only
  double mass_kg = 11.5;
  std::vector<double> inertia_kg_m2 = {0.16, 0.16, 0.16};
  // x, y, z, roll, pitch, yaw: kg, kg·m²; N/(m/s), N·m/(rad/s); N/(m/s)², N·m/(rad/s)².
  std::vector<double> added_mass = {5.5, 12.7, 14.57, 0.12, 0.12, 0.12};
  std::vector<double> linear_drag = {4.03, 6.22, 5.18, 0.07, 0.07, 0.07};
  std::vector<double> quadratic_drag = {18.18, 21.66, 36.99, 1.55, 1.55, 1.55};
  double net_buoyancy_n = 0;              // upward
  double thruster_lag_s = 0.2;            // of the rotors' speed, first order
  double velocity_gain = 4;               // 1/s, times mass: N per m/s
  double velocity_integral = 1.5;         // 1/s²
  double rate_gain = 5;                   // 1/s
  double rate_integral = 2;               // 1/s²
  double acceleration_smoothing_s = 0.4;  // of the acceleration feed-forward; 0: none
  double slew_n_s = 200;                  // largest change of one thruster's thrust
};

struct VehicleConfig {
  std::string kind = "none";  // none | rov | agv | arm
  RovConfig rov;
  AgvConfig agv;
  ArmConfig arm;
};

void describe(Visitor& v, CurveConfig& c);
void describe(Visitor& v, ThrusterConfig& c);
void describe(Visitor& v, RovConfig& c);
void describe(Visitor& v, VehicleConfig& c);

}  // namespace gannet::vehicle
