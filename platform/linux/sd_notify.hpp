// Tells systemd how the service does: READY=1, WATCHDOG=1, STOPPING=1, STATUS=… (sd_notify(3)).
// Control thread.
#pragma once

#include <string_view>

#include "platform/base/time.hpp"

namespace gannet::linux_os {

// False: no manager listens (NOTIFY_SOCKET is not set), or it could not be told.
bool sd_notify(std::string_view state);

// How often the manager wants WATCHDOG=1 at the least (WATCHDOG_USEC, meant for this process); 0:
// not at all. Half of it is a good period.
Duration sd_watchdog();

}  // namespace gannet::linux_os
