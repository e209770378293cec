// A CAN interface that this daemon commands and no other. The kernel lets any number of programs
// send on one bus; two daemons would both steer. Cameras and GPIO lines need no such claim: the
// kernel lends them once. The claim is an abstract Unix socket: like a CAN interface its name
// belongs to one network namespace, and it ends with the process, however that ends. Start-up only;
// the daemon owns it.
#pragma once

#include <string>

#include "platform/base/result.hpp"
#include "platform/linux/unix_socket.hpp"

namespace gannet::daemon {

// Error: another gannetd has it.
Result<linux_os::UnixListener> claim_interface(const std::string& interface);

}  // namespace gannet::daemon
