#include "hal/drive/odrive_config.hpp"

namespace gannet::hal {

void describe(Visitor& v, OdriveConfig& c) {
  v.field("firmware", c.firmware,
          {.choices = {"0.5", "0.6"},
           .help = "The firmware's generation: the errors' bits moved between them."});
  v.field("input_mode", c.input_mode,
          {.choices = {"ramp", "direct"},
           .help = "ramp: the drive ramps to each speed as set in it (vel_ramp_rate); direct: it "
                   "takes each speed at once (passthrough)."});
  v.field(
      "heartbeat_timeout_s", c.heartbeat_timeout_s,
      {.min = 0.02,
       .max = 10,
       .unit = "s",
       .help = "A drive without a heartbeat for longer is lost; it sends one every 0.1 s unless "
               "set otherwise."});
  v.field("guard_time_s", c.guard_time_s,
          {.min = 0.05,
           .max = 10,
           .unit = "s",
           .help = "A drive whose watchdog has not expired after so much silence does not stop by "
                   "itself when the daemon dies. Longer than watchdog_timeout in the drive."});
  v.field("accept_unguarded", c.accept_unguarded,
          {.help = "True lets motors be armed that do not stop by themselves when the daemon dies. "
                   "Then something else must cut their power."});
}

}  // namespace gannet::hal
