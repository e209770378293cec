// CanSocket: a raw CAN socket bound to one interface: what the kernel hands over, before it means
// anything. SocketCanBus makes a bus of it. It keeps its old socket until a new one is open, so
// that there is always one to ask by. Created at start-up; then one thread, RT safe: takes no
// memory, and waits for nothing but the kernel's network lock in open(), which `ip link` may hold
// for moments.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hal/can/can_calls.hpp"
#include "hal/can/can_frame.hpp"
#include "hal/can/can_wire.hpp"
#include "platform/base/result.hpp"
#include "platform/base/time.hpp"

namespace gannet::hal {

// One message of the kernel's.
struct CanArrival {
  CanFrame frame;
  bool is_frame = false;  // false: a remote frame, one of CAN FD, or nonsense
  bool has_stamp = false;
  Duration stamp = {};  // of arrival, since the epoch of CLOCK_REALTIME
};

class CanSocket {
 public:
  static constexpr int kBatch = 32;
  // What a waiting frame costs of SO_SNDBUF: a buffer of 512 bytes and its head of 256 on kernels
  // of 64 bits (6.1; more on others, then fewer frames wait). The kernel doubles what is set,
  // refuses a frame (EAGAIN) once the sum has reached it, and grants 4608 at least: 6 frames.
  static constexpr int kWaitingBytes = 768;
  enum class Step : std::uint8_t { kDone, kSocket, kInterface, kOptions, kBind };
  struct Failure {
    Step step = Step::kDone;
    int error = 0;
  };

  // Error: a name that no interface can have, more filters than the kernel takes.
  static Result<void> check(const std::string& interface, const std::vector<CanFilter>& wanted);
  // wanted: empty means all data frames. Error frames always come too, own frames never.
  // most_waiting: frames of ours that may wait for the bus; 0: as many as the kernel likes.
  CanSocket(const std::string& interface, const std::vector<CanFilter>& wanted, int most_waiting,
            CanCalls& calls);
  ~CanSocket();
  CanSocket(const CanSocket&) = delete;
  CanSocket& operator=(const CanSocket&) = delete;

  Failure open();
  Error explain(const Failure& failure) const;  // what to do about it; start-up only
  int fd() const { return fd_; }
  int bound_index() const { return index_; }
  int interface_index() { return calls_.interface_index(fd_, name()); }  // now, or −errno
  int flags() { return calls_.interface_flags(fd_, name()); }            // IFF_…, or −errno

  // At most kBatch frames: how many were taken, or −errno.
  int send(std::span<const CanFrame> frames);
  // At most kBatch arrivals: how many there were, 0 for none, or −errno.
  int receive(std::span<CanArrival> arrivals);
  std::uint64_t dropped() const { return dropped_; }  // for want of room, by all sockets so far

 private:
  struct Filter {  // as the kernel has it
    std::uint32_t id, mask;
  };
  struct alignas(cmsghdr) Control {
    std::array<char, 128> bytes;
  };
  const char* name() const { return interface_.c_str(); }
  int set_options(int fd);
  void read_control(msghdr& message, CanArrival& arrival);

  const std::string interface_;
  CanCalls& calls_;
  std::vector<Filter> filters_;
  const int most_waiting_;
  int fd_ = -1;
  int index_ = 0;
  std::uint64_t dropped_ = 0;
  std::uint32_t socket_drops_ = 0;  // as this socket counts
  std::array<mmsghdr, kBatch> messages_ = {};
  std::array<iovec, kBatch> parts_ = {};
  std::array<CanWire, kBatch> wires_ = {};
  std::array<Control, kBatch> controls_ = {};
};

}  // namespace gannet::hal
