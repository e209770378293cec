// The parameters of ODrive drives, described once. Start-up only.
#pragma once

#include <string>

#include "platform/base/describe.hpp"

namespace gannet::hal {

struct OdriveConfig {
  std::string firmware = "0.6";
  std::string input_mode = "ramp";
  double heartbeat_timeout_s = 0.5;
  double guard_time_s = 1;
  bool accept_unguarded = false;
};

void describe(Visitor& v, OdriveConfig& c);

}  // namespace gannet::hal
