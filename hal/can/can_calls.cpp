#include "hal/can/can_calls.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace gannet::hal {
namespace {

constexpr int kCanRawProtocol = 1;  // CAN_RAW of linux/can.h

int checked(int result) { return result < 0 ? -errno : result; }

ifreq request_of(const char* name) {
  ifreq request = {};
  std::strncpy(request.ifr_name, name, sizeof request.ifr_name - 1);
  return request;
}

class LinuxCanCalls final : public CanCalls {
 public:
  int open_socket() override {
    return checked(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, kCanRawProtocol));
  }
  void close_socket(int fd) override { ::close(fd); }
  int set_option(int fd, int level, int name, const void* value, socklen_t size) override {
    return checked(::setsockopt(fd, level, name, value, size));
  }
  int bind_socket(int fd, const sockaddr* address, socklen_t size) override {
    return checked(::bind(fd, address, size));
  }
  int interface_index(int fd, const char* name) override {
    ifreq request = request_of(name);
    const int result = checked(::ioctl(fd, SIOCGIFINDEX, &request));
    return result < 0 ? result : request.ifr_ifindex;
  }
  int interface_flags(int fd, const char* name) override {
    ifreq request = request_of(name);
    const int result = checked(::ioctl(fd, SIOCGIFFLAGS, &request));
    return result < 0 ? result : static_cast<unsigned short>(request.ifr_flags);
  }
  int send_batch(int fd, mmsghdr* messages, unsigned count) override {
    return checked(::sendmmsg(fd, messages, count, MSG_DONTWAIT));
  }
  int receive_batch(int fd, mmsghdr* messages, unsigned count) override {
    return checked(::recvmmsg(fd, messages, count, MSG_DONTWAIT, nullptr));
  }
  std::int64_t clock_ns(clockid_t clock) override {
    timespec t = {};
    clock_gettime(clock, &t);
    return t.tv_sec * std::int64_t{1'000'000'000} + t.tv_nsec;
  }
};

}  // namespace

CanCalls& linux_can_calls() {
  static LinuxCanCalls calls;
  return calls;
}

}  // namespace gannet::hal
