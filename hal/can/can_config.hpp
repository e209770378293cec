// The CAN bus's parameters, described once. Start-up only.
#pragma once

#include <string>

#include "platform/base/describe.hpp"

namespace gannet::hal {

struct CanConfig {
  std::string kind = "local";
  std::string path = "/run/gannet/can0";
  std::string interface = "can0";
};

void describe(Visitor& v, CanConfig& c);

}  // namespace gannet::hal
