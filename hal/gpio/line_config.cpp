#include "hal/gpio/line_config.hpp"

namespace gannet::hal {

void describe(Visitor& v, LineConfig& c) {
  v.field("kind", c.kind,
          {.choices = {"none", "simulated"},
           .help = "none: the line is not fitted; simulated: a line of gannet-world."});
  v.field("path", c.path, {.help = "Where the line is: the lines' file for kind simulated."});
  v.field("name", c.name, {.help = "The line's name there."});
  v.field("active_low", c.active_low,
          {.help = "True where the low level is the active one, as with a normally closed e-stop "
                   "switch to ground."});
}

}  // namespace gannet::hal
