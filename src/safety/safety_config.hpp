// Limits of the supervisor and the watchdogs, described once. Trivially copyable, so that it can
// be set live. describe: start-up only.
#pragma once

#include "platform/base/describe.hpp"

namespace gannet::safety {

struct SafetyConfig {
  double full_age_s = 0.3;           // oldest estimate that is still followed
  double full_sigma_m = 0.05;        // largest position uncertainty that is still followed
  double hold_limit_s = 10;          // Holding → Standby after this long
  double manual_age_s = 0.3;         // oldest hand command that still counts
  double camera_age_s = 0.5;         // no frame for longer: the cameras are dead
  double bus_age_s = 0.5;            // no frame sent or received for longer: the bus is down
  double estop_release_s = 0.05;     // the e-stop is released when quiet for so long
  double estop_discrepancy_s = 0.1;  // its two channels may disagree for so long
  bool accept_no_estop = false;      // arm a vehicle that has no e-stop line
  double motor_temperature_c = 0;    // a motor told to be hotter exceeds its limit; 0: not watched
  double motor_current_a = 0;        // … or to draw more; 0: not watched
  double motor_limit_s = 1;          // exceeded for longer is a fault
  int overrun_limit = 20;            // missed periods within overrun_window_s that are a fault
  double overrun_window_s = 1;
};

void describe(Visitor& v, SafetyConfig& c);

}  // namespace gannet::safety
