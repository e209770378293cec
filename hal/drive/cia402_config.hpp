// The parameters of CiA 402 drives, described once. Start-up only.
#pragma once

#include <string>

#include "platform/base/describe.hpp"

namespace gannet::hal {

struct Cia402Config {
  std::string mode = "profile_velocity";
  int pdo = 1;
  std::string velocity_unit = "rpm";
  double increments_per_rev = 4096;
  double gear_ratio = 1;
  double acceleration_rad_s2 = 0;
  double quick_stop_rad_s2 = 0;
  bool report_current = true;
  bool report_position = false;
  std::string stop = "quick_stop";
  double stop_time_s = 1;
  double heartbeat_period_s = 0.05;
  double guard_time_s = 0.2;
  std::string guard_reaction = "quick_stop";
  bool accept_unguarded = false;
  double node_heartbeat_s = 0.1;
  double node_timeout_s = 0.35;
  double sdo_timeout_s = 0.1;

  double servo_period_s = 0.005;  // no key of its own: the daemon says it, from its servo rate
};

void describe(Visitor& v, Cia402Config& c);

// The drive's velocity units for one rad/s of the driven shaft. 0: an unknown unit.
double velocity_units_per_rad_s(const Cia402Config& config);

// Encoder increments for one rad of the driven shaft.
double position_units_per_rad(const Cia402Config& config);

// The transmit PDO, 1 to 4, that brings the position: the one after pdo.
inline int position_pdo(const Cia402Config& config) { return config.pdo % 4 + 1; }

}  // namespace gannet::hal
