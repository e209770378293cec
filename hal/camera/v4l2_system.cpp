#include "hal/camera/v4l2_system.hpp"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "platform/linux/clock.hpp"

namespace gannet::hal {
namespace {

class KernelV4l2 final : public V4l2System {
 public:
  int open(const std::string& path) override {
    const int fd = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    return fd >= 0 ? fd : -errno;
  }
  void close(int fd) override { ::close(fd); }

  int ioctl(int fd, unsigned long request, void* argument) override {
    int status = 0;
    do status = ::ioctl(fd, request, argument);
    while (status < 0 && errno == EINTR);
    return status < 0 ? -errno : 0;
  }

  void* map(int fd, std::size_t bytes, std::int64_t offset) override {
    // Writable too: some drivers map their buffers in no other way.
    void* const memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd, offset);
    return memory == MAP_FAILED ? nullptr : memory;
  }
  void unmap(void* memory, std::size_t bytes) override { ::munmap(memory, bytes); }

  int poll(std::span<pollfd> fds, TimePoint until) override {
    const std::int64_t ns = std::max<std::int64_t>(0, (until - now()).count());
    const timespec timeout = {static_cast<time_t>(ns / 1'000'000'000),
                              static_cast<long>(ns % 1'000'000'000)};
    const int ready = ::ppoll(fds.data(), fds.size(), &timeout, nullptr);
    return ready >= 0 ? ready : -errno;
  }
  TimePoint now() const override { return linux_os::monotonic_now(); }
};

}  // namespace

V4l2System& kernel_v4l2() {
  static KernelV4l2 kernel;
  return kernel;
}

}  // namespace gannet::hal
