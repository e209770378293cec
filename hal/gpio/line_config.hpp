// A digital line's parameters, described once. Start-up only.
#pragma once

#include <string>

#include "platform/base/describe.hpp"

namespace gannet::hal {

struct LineConfig {
  std::string kind = "none";
  std::string path = "/dev/shm/gannet-lines";
  std::string name = "";
  bool active_low = false;
};

void describe(Visitor& v, LineConfig& c);

}  // namespace gannet::hal
