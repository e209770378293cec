// The parameters of DroneCAN ESCs, described once. Start-up only.
#pragma once

#include "platform/base/describe.hpp"

namespace gannet::hal {

struct DroneCanConfig {
  double esc_timeout_s = 0;
  bool accept_unguarded = false;

  // Whether the ESCs stop by themselves when we fall silent: a person's word, for no message of
  // DroneCAN asks an ESC for its time-out, and at rest nothing shows that it passed.
  bool is_guarded() const { return esc_timeout_s > 0; }
};

void describe(Visitor& v, DroneCanConfig& c);

}  // namespace gannet::hal
