// ScriptedCan plays a kernel with one CAN interface: what raw sockets answer when it is there,
// down, taken away, full, or when the wall clock steps. Its answers are those of net/can/raw.c. One
// thread.
#pragma once

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "hal/can/can_calls.hpp"
#include "hal/can/can_wire.hpp"
#include "platform/base/fixed_vector.hpp"
#include "platform/base/time.hpp"

namespace gannet::test {

constexpr std::int64_t kSecond = 1'000'000'000;

class ScriptedCan final : public hal::CanCalls {
 public:
  struct Incoming {
    hal::CanWire wire = {};
    unsigned size = hal::kCanWireBytes;
    std::int64_t stamp_ns = 0;  // 0: none
    std::uint32_t drops = 0;    // as SO_RXQ_OVFL tells; 0: not told
    bool is_cut = false;        // longer than the reader's room
  };

  // ---- the interface
  std::string name = "can0";
  int index = 3;  // −1: there is none
  int flags = IFF_UP | IFF_RUNNING;
  bool is_can = true;
  bool has_can = true;  // the kernel
  std::int64_t monotonic_ns = 100 * kSecond;
  std::int64_t realtime_ns = 1'700'000'000 * kSecond;
  int room = 1 << 20;       // frames until the queue is full
  int failing_option = -1;  // set_option of this name fails

  void advance(std::int64_t ns) {
    monotonic_ns += ns;
    realtime_ns += ns;
  }
  TimePoint now() const { return time_from_ns(monotonic_ns); }

  void go_down() {
    flags &= ~(IFF_UP | IFF_RUNNING);
    pending_error_ = ENETDOWN;
  }
  void come_up() { flags |= IFF_UP | IFF_RUNNING; }
  void take_away() {
    index = -1;
    bound_ = 0;
    pending_error_ = ENODEV;
  }
  void bring_back(int new_index) {
    index = new_index;
    come_up();
  }

  // The bus takes nothing: frames wait, each charged to its socket. Then it takes all of them.
  void hold_up() { is_held_up_ = true; }
  void flow() {
    is_held_up_ = false;
    waiting_bytes_ = 0;
  }

  void arrive(const hal::CanFrame& frame) {
    queue_.push_back({hal::to_wire(frame), hal::kCanWireBytes, realtime_ns, 0, false});
  }
  void arrive(const Incoming& incoming) { queue_.push_back(incoming); }
  void arrive_error(std::uint32_t classes, std::array<std::uint8_t, 8> data = {}) {
    arrive(hal::CanFrame{.id = classes, .error = true, .length = 8, .data = data});
  }

  // ---- what was done
  std::vector<std::string> calls;  // "socket", "option 101.1", "bind 3"; only while `is_noting`
  bool is_noting = true;
  std::map<std::pair<int, int>, std::vector<unsigned char>> options;
  std::vector<can_frame> sent;
  std::set<int> open_fds;
  int send_calls = 0, receive_calls = 0, index_calls = 0, flags_calls = 0;
  int waiting() const { return static_cast<int>(queue_.size()); }

  // ---- CanCalls
  int open_socket() override {
    note("socket");
    if (!has_can) return -EAFNOSUPPORT;
    if (is_noting) open_fds.insert(next_fd_);
    return next_fd_++;
  }
  void close_socket(int fd) override {
    note("close");
    if (is_noting) open_fds.erase(fd);
  }
  int set_option(int, int level, int option, const void* value, socklen_t size) override {
    if (option == failing_option) return -EPERM;
    if (!is_noting) return 0;
    calls.push_back("option " + std::to_string(level) + "." + std::to_string(option));
    const auto* bytes = static_cast<const unsigned char*>(value);
    options[{level, option}].assign(bytes, bytes + size);
    return 0;
  }
  int bind_socket(int fd, const sockaddr* address, socklen_t size) override {
    note("bind");
    sockaddr_can can = {};
    if (size < sizeof can) return -EINVAL;
    std::memcpy(&can, address, sizeof can);
    if (can.can_ifindex != index || !is_can) return -ENODEV;
    bound_ = can.can_ifindex;
    bound_fd_ = fd;
    pending_error_ = (flags & IFF_UP) != 0 ? 0 : ENETDOWN;
    return 0;
  }
  int interface_index(int, const char* asked) override {
    ++index_calls;
    return index > 0 && name == asked ? index : -ENODEV;
  }
  int interface_flags(int, const char* asked) override {
    ++flags_calls;
    return index > 0 && name == asked ? flags : -ENODEV;
  }
  int send_batch(int fd, mmsghdr* messages, unsigned count) override {
    ++send_calls;
    if (bound_ == 0 || bound_ != index || fd != bound_fd_) return -ENXIO;
    if (const int error = take_error(); error != 0) return -error;
    if ((flags & IFF_UP) == 0) return -ENETDOWN;
    unsigned done = 0;
    bool is_socket_full = false;
    for (; done < count && room > 0; ++done, --room) {
      is_socket_full = is_held_up_ && waiting_bytes_ >= send_buffer();
      if (is_socket_full) break;
      if (is_held_up_) waiting_bytes_ += kTrueSize;
      can_frame frame;
      std::memcpy(&frame, messages[done].msg_hdr.msg_iov->iov_base, sizeof frame);
      if (is_noting) sent.push_back(frame);
    }
    if (done > 0) return static_cast<int>(done);
    return is_socket_full ? -EAGAIN : -ENOBUFS;
  }
  int receive_batch(int, mmsghdr* messages, unsigned count) override {
    ++receive_calls;
    if (const int error = take_error(); error != 0) return -error;
    unsigned done = 0;
    for (; done < count && !queue_.empty(); ++done) {
      hand_over(queue_.front(), messages[done]);
      queue_.pop_front();
    }
    return done == 0 ? -EAGAIN : static_cast<int>(done);
  }
  std::int64_t clock_ns(clockid_t clock) override {
    return clock == CLOCK_REALTIME ? realtime_ns : monotonic_ns;
  }

 private:
  void note(const char* call) {
    if (is_noting) calls.emplace_back(call);
  }
  // As net/core/sock.c takes SO_SNDBUF: doubled, and never less than this.
  static constexpr int kTrueSize = 768, kLeastBuffer = 4608;
  int send_buffer() const {
    const auto found = options.find({SOL_SOCKET, SO_SNDBUF});
    if (found == options.end()) return 212992;
    int asked = 0;
    std::memcpy(&asked, found->second.data(), sizeof asked);
    return std::max(2 * asked, kLeastBuffer);
  }
  int take_error() { return std::exchange(pending_error_, 0); }

  template <class T>
  static void add_control(msghdr& header, std::size_t& used, int type, const T& value) {
    if (header.msg_control == nullptr || used + CMSG_SPACE(sizeof value) > header.msg_controllen) {
      return;
    }
    cmsghdr control = {};
    control.cmsg_level = SOL_SOCKET;
    control.cmsg_type = type;
    control.cmsg_len = CMSG_LEN(sizeof value);
    char* at = static_cast<char*>(header.msg_control) + used;
    std::memcpy(at, &control, sizeof control);
    std::memcpy(at + CMSG_LEN(0), &value, sizeof value);
    used += CMSG_SPACE(sizeof value);
  }

  static void hand_over(const Incoming& incoming, mmsghdr& message) {
    msghdr& header = message.msg_hdr;
    std::memcpy(header.msg_iov->iov_base, incoming.wire.data(),
                std::min<std::size_t>(header.msg_iov->iov_len, incoming.size));
    message.msg_len = incoming.size;
    header.msg_flags = incoming.is_cut ? MSG_TRUNC : 0;
    std::size_t used = 0;
    if (incoming.drops != 0) add_control(header, used, SO_RXQ_OVFL, incoming.drops);
    if (incoming.stamp_ns != 0) {
      const timespec stamp = {incoming.stamp_ns / kSecond, incoming.stamp_ns % kSecond};
      add_control(header, used, SCM_TIMESTAMPNS, stamp);
    }
    header.msg_controllen = used;
  }

  std::deque<Incoming> queue_;
  int next_fd_ = 10;
  int bound_ = 0, bound_fd_ = -1;
  int pending_error_ = 0;
  bool is_held_up_ = false;
  int waiting_bytes_ = 0;
};

}  // namespace gannet::test
