#include "hal/gpio/line_config.hpp"

namespace gannet::hal {

void describe(Visitor& v, LineConfig& c) {
  v.field("kind", c.kind,
          {.choices = {"none", "gpiod", "simulated"},
           .help = "none: the line is not fitted; gpiod: a line of the kernel's; simulated: one of "
                   "gannet-world."});
  v.field("chip", c.chip,
          {.help = "For kind gpiod: the chip's device file, or its label as gpiodetect says it."});
  v.field("line", c.line, {.help = "For kind gpiod: the line's name, or its offset on the chip."});
  v.field("bias", c.bias,
          {.choices = {"as_is", "pull_up", "pull_down"},
           .help = "For kind gpiod: the chip's own pull resistor, where it has one."});
  v.field("path", c.path, {.help = "For kind simulated: the lines' file."});
  v.field("name", c.name, {.help = "For kind simulated: the line's name there."});
  v.field("active_low", c.active_low,
          {.help = "True where the low level is the active one. An e-stop switch that is normally "
                   "closed to ground opens when pressed: its active level is the high one, and so "
                   "is that of a broken wire."});
}

}  // namespace gannet::hal
