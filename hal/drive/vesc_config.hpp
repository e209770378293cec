// The parameters of VESC drives, described once. Start-up only.
#pragma once

#include <string>

#include "platform/base/describe.hpp"

namespace gannet::hal {

struct VescConfig {
  std::string mode = "duty";
  double full_duty = 0.95;
  double full_current_a = 20;
  std::string stop = "release";
  double brake_current_a = 5;
  double stop_time_s = 0.5;
  double guard_time_s = 1.5;
  bool accept_unguarded = false;
};

void describe(Visitor& v, VescConfig& c);

}  // namespace gannet::hal
