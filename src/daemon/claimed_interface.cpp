#include "src/daemon/claimed_interface.hpp"

namespace gannet::daemon {

Result<linux_os::UnixListener> claim_interface(const std::string& interface) {
  auto claim =
      linux_os::UnixListener::listen("@gannetd/can/" + interface, linux_os::SocketKind::kStream);
  if (claim) return claim;
  return Error{"can.interface: another gannetd commands " + interface +
               ": stop that one first, or choose another interface"};
}

}  // namespace gannet::daemon
