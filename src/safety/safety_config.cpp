#include "src/safety/safety_config.hpp"

namespace gannet::safety {

void describe(Visitor& v, SafetyConfig& c) {
  v.field("full_age_s", c.full_age_s,
          {.min = 0.02,
           .max = 5,
           .unit = "s",
           .help = "Oldest image whose pose is still followed; older: hold."});
  v.field("full_sigma_m", c.full_sigma_m,
          {.min = 0.001,
           .max = 1,
           .unit = "m",
           .help = "Largest standard deviation of the target's position that is still followed."});
  v.field(
      "hold_limit_s", c.hold_limit_s,
      {.min = 0, .max = 3600, .unit = "s", .help = "Holding without a target for longer disarms."});
  v.field("manual_age_s", c.manual_age_s,
          {.min = 0.05,
           .max = 5,
           .unit = "s",
           .help = "Oldest command of a person's hand that still counts."});
  v.field("camera_age_s", c.camera_age_s,
          {.min = 0.05,
           .max = 10,
           .unit = "s",
           .help = "Without a frame for longer the cameras count as dead."});
  v.field("bus_age_s", c.bus_age_s,
          {.min = 0.02,
           .max = 10,
           .unit = "s",
           .help = "Without any frame on the bus for longer it counts as down."});
  v.field("estop_release_s", c.estop_release_s,
          {.min = 0,
           .max = 5,
           .unit = "s",
           .help = "The e-stop counts as released when it has been quiet for so long; pressing "
                   "acts at once."});
  v.field("estop_discrepancy_s", c.estop_discrepancy_s,
          {.min = 0.01,
           .max = 5,
           .unit = "s",
           .help = "The two channels of an e-stop may disagree for so long, while the button "
                   "moves."});
  v.field("accept_no_estop", c.accept_no_estop,
          {.help = "Arm a vehicle although gpio.estop.kind is \"none\": nothing but the programs "
                   "could stop it."});
  v.field("motor_temperature_c", c.motor_temperature_c,
          {.min = 0,
           .max = 300,
           .unit = "°C",
           .help = "A motor whose drive tells more exceeds its limit; 0: not watched."});
  v.field("motor_current_a", c.motor_current_a,
          {.min = 0,
           .max = 2000,
           .unit = "A",
           .help = "A motor whose drive tells more, forward or back, exceeds its limit; 0: not "
                   "watched."});
  v.field("motor_limit_s", c.motor_limit_s,
          {.min = 0,
           .max = 60,
           .unit = "s",
           .help = "A motor's limit that is exceeded for longer is a fault."});
  v.field("overrun_limit", c.overrun_limit,
          {.min = 1,
           .max = 100000,
           .help = "Missed servo periods within the window that are a fault."});
  v.field("overrun_window_s", c.overrun_window_s,
          {.min = 0.01, .max = 60, .unit = "s", .help = "Window in which overruns are counted."});
}

}  // namespace gannet::safety
