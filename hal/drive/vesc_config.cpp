#include "hal/drive/vesc_config.hpp"

namespace gannet::hal {

void describe(Visitor& v, VescConfig& c) {
  v.field("mode", c.mode,
          {.choices = {"duty", "speed", "current"},
           .help = "What a setpoint commands: duty: that part of full_duty; speed: that part of "
                   "drive.motor.full_speed_rad_s; current: that part of full_current_a."});
  v.field("full_duty", c.full_duty,
          {.min = 0.01, .max = 1, .help = "The duty cycle at full command."});
  v.field("full_current_a", c.full_current_a,
          {.min = 0.01, .max = 1000, .unit = "A", .help = "The motor's current at full command."});
  v.field("stop", c.stop,
          {.choices = {"release", "brake"},
           .help = "How a motor that is no longer enabled stops: by coasting, or braked by "
                   "brake_current_a."});
  v.field("brake_current_a", c.brake_current_a,
          {.min = 0, .max = 1000, .unit = "A", .help = "For stop = brake."});
  v.field("stop_time_s", c.stop_time_s,
          {.min = 0.05,
           .max = 10,
           .unit = "s",
           .help = "How long a motor that is no longer enabled, or that came back, is commanded to "
                   "stop; never shorter than feedback_timeout_s. Then it is left alone, so that "
                   "its own time-out can be seen to pass."});
  v.field("guard_time_s", c.guard_time_s,
          {.min = 0.05,
           .max = 10,
           .unit = "s",
           .help = "A VESC whose own time-out has not passed after so much silence does not stop "
                   "by itself when the daemon dies. Longer than the time-out set in the VESC."});
  v.field("accept_unguarded", c.accept_unguarded,
          {.help = "True lets motors be armed that do not stop by themselves when the daemon dies. "
                   "Then something else must cut their power."});
}

}  // namespace gannet::hal
