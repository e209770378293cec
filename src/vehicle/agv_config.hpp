// The AGV as data, described once. Defaults are those of a small indoor carrier; measure your own.
// Start-up only.
#pragma once

#include <vector>

#include "platform/base/describe.hpp"

namespace gannet::vehicle {

struct AgvConfig {
  double wheel_radius_m = 0.1;
  double track_m = 0.5;                // between the wheels' lines of contact
  double gear_ratio = 15;              // turns of what the drive reports for one of the wheel
  double max_wheel_speed_rad_s = 16;   // of the wheel
  double max_acceleration_m_s2 = 1.0;  // along its way
  double max_jerk_m_s3 = 8;
  double max_acceleration_rad_s2 = 3;  // of its turn
  double max_jerk_rad_s3 = 30;
  double hold_deceleration_m_s2 = 0.5;  // when it may only hold, as when its target is lost
  bool rear_free = false;               // it may drive backwards
  double feedback_age_s = 0.1;

  // No key of its own: the daemon says it, from drive.motor.full_speed_rad_s of the left and the
  // right one; empty: max_wheel_speed_rad_s is full speed.
  std::vector<double> full_speed_rad_s;
};

void describe(Visitor& v, AgvConfig& c);

}  // namespace gannet::vehicle
