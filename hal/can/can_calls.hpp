// The system calls of a raw CAN socket, one virtual function each and nothing more, so that tests
// can play the kernel. Every call returns at once; −errno tells a failure. RT safe but for what is
// said beside it.
#pragma once

#include <net/if.h>
#include <sys/socket.h>
#include <time.h>

#include <cstdint>

namespace gannet::hal {

class CanCalls {
 public:
  virtual ~CanCalls() = default;
  virtual int open_socket() = 0;  // non-blocking; returns the descriptor
  virtual void close_socket(int fd) = 0;
  virtual int set_option(int fd, int level, int name, const void* value, socklen_t size) = 0;
  virtual int bind_socket(int fd, const sockaddr* address, socklen_t size) = 0;
  // By the interface's name, which ends with a zero. A process with CAP_NET_ADMIN that asks for
  // an interface that is not there makes the kernel look for a module of that name.
  virtual int interface_index(int fd, const char* name) = 0;  // > 0
  virtual int interface_flags(int fd, const char* name) = 0;  // IFF_…
  virtual int send_batch(int fd, mmsghdr* messages, unsigned count) = 0;
  virtual int receive_batch(int fd, mmsghdr* messages, unsigned count) = 0;
  virtual std::int64_t clock_ns(clockid_t clock) = 0;
};

// The real ones; without state, for any thread.
CanCalls& linux_can_calls();

}  // namespace gannet::hal
