#include "hal/can/can_socket.hpp"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>

namespace gannet::hal {

static_assert(sizeof(can_frame) == kCanWireBytes);

// ---- opening ------------------------------------------------------------------------------------

Result<void> CanSocket::check(const std::string& interface, const std::vector<CanFilter>& wanted) {
  if (interface.empty() || interface.size() >= IFNAMSIZ) {
    return Error{"CAN interface '" + interface + "': a name has 1 to " +
                 std::to_string(IFNAMSIZ - 1) + " bytes"};
  }
  if (wanted.size() <= CAN_RAW_FILTER_MAX) return {};
  return Error{"CAN interface '" + interface + "': the kernel takes " +
               std::to_string(CAN_RAW_FILTER_MAX) + " filters, not " +
               std::to_string(wanted.size())};
}

CanSocket::CanSocket(const std::string& interface, const std::vector<CanFilter>& wanted,
                     int most_waiting, CanCalls& calls)
    : interface_(interface), calls_(calls), most_waiting_(most_waiting) {
  static_assert(sizeof(Filter) == sizeof(can_filter));
  for (const CanFilter& filter : wanted) {
    // Exactly these: the other format, and remote frames, match no filter.
    const std::uint32_t bits = filter.extended ? CAN_EFF_MASK : CAN_SFF_MASK;
    filters_.push_back({(filter.id & bits) | (filter.extended ? CAN_EFF_FLAG : 0),
                        (filter.mask & bits) | CAN_EFF_FLAG | CAN_RTR_FLAG});
  }
  if (wanted.empty()) filters_.push_back({0, CAN_RTR_FLAG});
  for (std::size_t i = 0; i < kBatch; ++i) {
    parts_[i] = {wires_[i].data(), wires_[i].size()};
    messages_[i].msg_hdr.msg_iov = &parts_[i];
    messages_[i].msg_hdr.msg_iovlen = 1;
  }
}

CanSocket::~CanSocket() {
  if (fd_ >= 0) calls_.close_socket(fd_);
}

CanSocket::Failure CanSocket::open() {
  const int fd = calls_.open_socket();
  if (fd < 0) return {Step::kSocket, -fd};
  const auto fail = [&](Step step, int result) {
    calls_.close_socket(fd);
    return Failure{step, -result};
  };
  const int index = calls_.interface_index(fd, name());
  if (index < 0) return fail(Step::kInterface, index);
  if (const int result = set_options(fd); result < 0) return fail(Step::kOptions, result);
  sockaddr_can address = {};
  address.can_family = AF_CAN;
  address.can_ifindex = index;
  const int bound =
      calls_.bind_socket(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  if (bound < 0) return fail(Step::kBind, bound);
  if (fd_ >= 0) calls_.close_socket(fd_);
  fd_ = fd;
  index_ = index;
  socket_drops_ = 0;
  return {};
}

// Before binding, so that no frame gets past them.
int CanSocket::set_options(int fd) {
  const can_err_mask_t errors = CAN_ERR_MASK;
  const int on = 1, off = 0, send_buffer = most_waiting_ * kWaitingBytes / 2;
  const struct {
    int level, name;
    const void* value;
    std::size_t size;
  } options[] = {
      {SOL_CAN_RAW, CAN_RAW_FILTER, filters_.data(), filters_.size() * sizeof(Filter)},
      {SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors},
      {SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, &off, sizeof off},
      {SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on},
      {SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on},
      {SOL_SOCKET, SO_SNDBUF, &send_buffer, sizeof send_buffer},
  };
  for (const auto& option : options) {
    if (option.name == SO_SNDBUF && option.level == SOL_SOCKET && most_waiting_ == 0) continue;
    const int result = calls_.set_option(fd, option.level, option.name, option.value,
                                         static_cast<socklen_t>(option.size));
    if (result < 0) return result;
  }
  return 0;
}

Error CanSocket::explain(const Failure& failure) const {
  const std::string what = "CAN interface '" + interface_ + "': ";
  if (failure.step == Step::kSocket &&
      (failure.error == EAFNOSUPPORT || failure.error == EPROTONOSUPPORT)) {
    return Error{what + "this kernel has no raw CAN sockets; try `modprobe can_raw`"};
  }
  if (failure.step == Step::kInterface && failure.error == ENODEV) {
    return Error{what +
                 "there is none of that name; bring it up with `systemctl start gannet-can@" +
                 interface_ + "`"};
  }
  if (failure.step == Step::kBind && failure.error == ENODEV) {
    return Error{what + "is no CAN interface (see `ip -details link show " + interface_ + "`)"};
  }
  const char* step = failure.step == Step::kSocket      ? "socket"
                     : failure.step == Step::kInterface ? "SIOCGIFINDEX"
                     : failure.step == Step::kOptions   ? "setsockopt"
                                                        : "bind";
  return Error{what + step + ": " + std::strerror(failure.error)};
}

// ---- frames -------------------------------------------------------------------------------------

int CanSocket::send(std::span<const CanFrame> frames) {
  assert(frames.size() <= kBatch);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    wires_[i] = to_wire(frames[i]);
    messages_[i].msg_hdr.msg_control = nullptr;
    messages_[i].msg_hdr.msg_controllen = 0;
  }
  return calls_.send_batch(fd_, messages_.data(), static_cast<unsigned>(frames.size()));
}

int CanSocket::receive(std::span<CanArrival> arrivals) {
  assert(arrivals.size() <= kBatch);
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    messages_[i].msg_hdr.msg_control = controls_[i].bytes.data();
    messages_[i].msg_hdr.msg_controllen = controls_[i].bytes.size();
  }
  const auto room = static_cast<unsigned>(arrivals.size());
  const int n = calls_.receive_batch(fd_, messages_.data(), room);
  for (std::size_t i = 0; static_cast<int>(i) < n; ++i) {
    const mmsghdr& message = messages_[i];
    const bool is_whole =
        (message.msg_hdr.msg_flags & MSG_TRUNC) == 0 && message.msg_len <= kCanWireBytes;
    arrivals[i] = {};
    arrivals[i].is_frame =
        is_whole && from_wire(std::span(wires_[i]).first(message.msg_len), arrivals[i].frame);
    read_control(messages_[i].msg_hdr, arrivals[i]);
  }
  return n == -EAGAIN ? 0 : n;
}

void CanSocket::read_control(msghdr& message, CanArrival& arrival) {
  for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c)) {
    if (c->cmsg_level != SOL_SOCKET) continue;
    if (c->cmsg_type == SCM_TIMESTAMPNS && c->cmsg_len >= CMSG_LEN(sizeof(timespec))) {
      timespec stamp;
      std::memcpy(&stamp, CMSG_DATA(c), sizeof stamp);
      arrival.stamp = Duration(stamp.tv_sec * std::int64_t{1'000'000'000} + stamp.tv_nsec);
      arrival.has_stamp = true;
    } else if (c->cmsg_type == SO_RXQ_OVFL && c->cmsg_len >= CMSG_LEN(sizeof(std::uint32_t))) {
      std::uint32_t drops;  // since the socket was made; it may wrap round
      std::memcpy(&drops, CMSG_DATA(c), sizeof drops);
      dropped_ += static_cast<std::uint32_t>(drops - socket_drops_);
      socket_drops_ = drops;
    }
  }
}

}  // namespace gannet::hal
