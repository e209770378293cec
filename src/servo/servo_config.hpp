// Parameters of the servo law, described once. ServoParams is trivially copyable and is set live;
// describe: start-up only.
#pragma once

#include <string>

#include "platform/base/describe.hpp"
#include "src/servo/goal.hpp"

namespace gannet::servo {

struct ServoParams {
  double position_gain = 1.2;  // 1/s
  double rotation_gain = 1.2;  // 1/s
  double max_speed_m_s = 0.4;  // of the approach, beyond the target's own motion
  double max_rate_rad_s = 0.6;
  double max_acceleration_m_s2 = 0.5;
  double max_acceleration_rad_s2 = 1.0;
  bool feed_forward = true;  // add the target's own velocity
  // The goal: target in Σ_H.
  double goal_x_m = 0;
  double goal_y_m = 0;
  double goal_z_m = 0.5;
  double goal_roll_deg = 0;  // R = Rz(yaw)·Ry(pitch)·Rx(roll) about Σ_H's x, y, z
  double goal_pitch_deg = 0;
  double goal_yaw_deg = 0;
  double near_m = 1.5;  // of follow_person: nearer than this it never drives
  // Axes of the body (REP-103) that the law asks for; the vehicle may leave some unreachable.
  bool control_x = true;
  bool control_y = true;
  bool control_z = true;
  bool control_roll = false;
  bool control_pitch = false;
  bool control_yaw = true;
};

struct ServoConfig {
  std::string law = "pose_regulation";
  ServoParams params;
};

Goal goal_of(const ServoParams& params);  // RT safe

void describe(Visitor& v, ServoConfig& c);

}  // namespace gannet::servo
