#include "hal/drive/dronecan_config.hpp"

namespace gannet::hal {

void describe(Visitor& v, DroneCanConfig& c) {
  v.field("esc_timeout_s", c.esc_timeout_s,
          {.min = 0,
           .max = 2,
           .unit = "s",
           .help = "How long after the last command the ESCs stop by themselves: what is set in "
                   "them, and was seen with the bus unplugged. DroneCAN has no question for it. "
                   "0: nobody knows; then arming is refused."});
  v.field("accept_unguarded", c.accept_unguarded,
          {.help = "True lets motors be armed that do not stop by themselves when the daemon dies. "
                   "Then something else must cut their power."});
}

}  // namespace gannet::hal
