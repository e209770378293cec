#include "hal/can/can_config.hpp"

namespace gannet::hal {

void describe(Visitor& v, CanConfig& c) {
  v.field("kind", c.kind,
          {.choices = {"local", "memory", "socketcan"},
           .help = "socketcan: an interface of Linux; local: frames over a Unix socket that "
                   "gannet-world or another hub serves; memory: a bus with nobody else on it, for "
                   "a try without motors."});
  v.field("interface", c.interface,
          {.help = "The interface for kind socketcan, as `ip link` names it; "
                   "gannet-can@.service brings it up."});
  v.field("path", c.path,
          {.help = "The hub's socket for kind local: a path, or @ and an abstract name."});
}

}  // namespace gannet::hal
