// The arm as data, described once: Denavit–Hartenberg parameters (J. Denavit, R. S. Hartenberg, "A
// kinematic notation for lower-pair mechanisms based on matrices", J. Appl. Mech. 22, 1955; frame
// i at the end of link i), limits and gears of its joints. The default is the Mitsubishi PA-10
// with seven joints (PA10-7C), S1 S2 S3 E1 E2 W1 W2, all a = 0:
//  - lengths 317, 450, 480, 70 mm, and S1 ±177°, S2 ±90°, S3 ±174°, E1 ±137°, E2 ±255°, W1 ±165°,
//    W2 ±255°: the robot's public model by OpenBionics (modelMitsubishiPA10.m, 2015);
//  - speeds 57, 57, 114, 114, 360, 360, 360 °/s: as usually quoted for the PA10-7C; the maker's
//    sheet could not be read: compare before you trust them;
//  - accelerations: assumed, full speed in 0.2 s; the maker publishes none.
// Start-up only.
#pragma once

#include <string>
#include <vector>

#include "platform/base/describe.hpp"

namespace gannet::vehicle {

inline constexpr int kMaxJoints = 10;

struct JointConfig {
  double a_m = 0;
  double alpha_deg = 0;
  double d_m = 0;
  double theta_deg = 0;  // added to the joint's angle
  double min_deg = -170;
  double max_deg = 170;
  double max_speed_deg_s = 60;
  double max_acceleration_deg_s2 = 300;
  double gear_ratio = 1;  // turns of what the drive reports for one of the joint
  double zero_deg = 0;    // the joint's angle where the drive's position is 0
  double rest_deg = 0;    // where the null space pulls it
};

struct ArmConfig {
  std::string robot = "pa10";                       // pa10 | custom
  std::vector<JointConfig> joints;                  // custom only
  std::vector<double> body_position_m = {0, 0, 0};  // of Σ_B in the last link's frame
  std::vector<double> body_turn_deg = {0, -90, 0};  // roll, pitch, yaw; so x points out of it
  double radian_as_m = 0.3;
  double singular_below_m = 0.06;
  double damping_m = 0.05;
  double posture_gain = 0.5;
  double limit_margin_deg = 5;
  double feedback_age_s = 0.05;

  // No key of its own: the daemon says it, from drive.motor.full_speed_rad_s; empty: each joint's
  // own fastest.
  std::vector<double> full_speed_rad_s;
};

std::vector<JointConfig> pa10_joints();
// The joints of the named robot, or the config's own.
std::vector<JointConfig> joints_of(const ArmConfig& config);

void describe(Visitor& v, JointConfig& c);
void describe(Visitor& v, ArmConfig& c);

}  // namespace gannet::vehicle
