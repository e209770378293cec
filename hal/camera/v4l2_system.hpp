// V4l2System: the system calls that V4L2 needs, behind one seam, so that tests can play a driver.
// Errors are negative errno values. Alone includes the kernel's V4L2 header; who needs its structs
// includes this file.
// open, close, map and unmap: normal threads. ioctl (to dequeue and queue), poll and now: RT safe.
#pragma once

#include <linux/videodev2.h>
#include <poll.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "platform/base/time.hpp"

namespace gannet::hal {

class V4l2System {
 public:
  virtual ~V4l2System() = default;

  virtual int open(const std::string& path) = 0;  // a descriptor, non-blocking
  virtual void close(int fd) = 0;
  virtual int ioctl(int fd, unsigned long request, void* argument) = 0;   // 0, or the error
  virtual void* map(int fd, std::size_t bytes, std::int64_t offset) = 0;  // null: refused
  virtual void unmap(void* memory, std::size_t bytes) = 0;
  // Until one of them is ready or the time has come; how many are ready.
  virtual int poll(std::span<pollfd> fds, TimePoint until) = 0;
  virtual TimePoint now() const = 0;
};

// The kernel's own; lives as long as the program.
V4l2System& kernel_v4l2();

}  // namespace gannet::hal
