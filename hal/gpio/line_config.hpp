// A digital line's parameters, described once. Start-up only.
#pragma once

#include <string>

#include "platform/base/describe.hpp"

namespace gannet::hal {

struct LineConfig {
  std::string kind = "none";
  std::string path = "/dev/shm/gannet-lines";  // kind simulated
  std::string name = "";
  std::string chip = "/dev/gpiochip0";  // kind gpiod
  std::string line = "";
  std::string bias = "as_is";
  bool active_low = false;
};

void describe(Visitor& v, LineConfig& c);

}  // namespace gannet::hal
