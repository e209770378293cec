#include "hal/can/socketcan_bus.hpp"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace gannet::hal {
namespace {

using std::chrono::milliseconds;

constexpr Duration kLookPeriod = milliseconds(10), kLongestBackoff = milliseconds(500);
constexpr Duration kStampSlack = milliseconds(1);  // clocks are not read at one instant

static_assert(sizeof(can_frame) == kCanWireBytes);

bool is_link_error(int error) { return error == ENETDOWN || error == ENODEV || error == ENXIO; }

}  // namespace

// ---- opening ------------------------------------------------------------------------------------

SocketCanBus::SocketCanBus(const std::string& interface, const std::vector<CanFilter>& wanted,
                           CanCalls& calls)
    : interface_(interface), calls_(calls) {
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

SocketCanBus::~SocketCanBus() {
  if (fd_ >= 0) calls_.close_socket(fd_);
}

Result<std::unique_ptr<SocketCanBus>> SocketCanBus::open(const std::string& interface,
                                                         const std::vector<CanFilter>& wanted,
                                                         TimePoint, CanCalls& calls) {
  if (interface.empty() || interface.size() >= IFNAMSIZ) {
    return Error{"CAN interface '" + interface + "': a name has 1 to " +
                 std::to_string(IFNAMSIZ - 1) + " bytes"};
  }
  if (wanted.size() > CAN_RAW_FILTER_MAX) {
    return Error{"CAN interface '" + interface + "': the kernel takes " +
                 std::to_string(CAN_RAW_FILTER_MAX) + " filters, not " +
                 std::to_string(wanted.size())};
  }
  std::unique_ptr<SocketCanBus> bus(new SocketCanBus(interface, wanted, calls));
  const Failure failure = bus->open_socket();
  if (failure.step != Step::kDone) return bus->explain(failure);
  return bus;
}

// The old socket stays until there is a new one. Takes no memory.
SocketCanBus::Failure SocketCanBus::open_socket() {
  const int fd = calls_.open_socket();
  if (fd < 0) return {Step::kSocket, -fd};
  const auto fail = [&](Step step, int result) {
    calls_.close_socket(fd);
    return Failure{step, -result};
  };
  const int index = calls_.interface_index(fd, interface_.c_str());
  if (index < 0) return fail(Step::kInterface, index);
  if (const int result = set_options(fd); result < 0) return fail(Step::kOptions, result);
  sockaddr_can address = {};
  address.can_family = AF_CAN;
  address.can_ifindex = index;
  emptied_ = monotonic();
  const int bound =
      calls_.bind_socket(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  if (bound < 0) return fail(Step::kBind, bound);
  if (fd_ >= 0) calls_.close_socket(fd_);
  fd_ = fd;
  index_ = index;
  socket_drops_ = 0;
  read_link();
  // Binding to an interface that is down leaves an error in the socket, which would else be taken
  // for another loss once it is up.
  if (link_ == Link::kDown) calls_.receive_batch(fd_, messages_.data(), 1);
  return {};
}

// Before binding, so that no frame gets past them.
int SocketCanBus::set_options(int fd) {
  const can_err_mask_t errors = CAN_ERR_MASK;
  const int on = 1, off = 0;
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
  };
  for (const auto& option : options) {
    const int result = calls_.set_option(fd, option.level, option.name, option.value,
                                         static_cast<socklen_t>(option.size));
    if (result < 0) return result;
  }
  return 0;
}

Error SocketCanBus::explain(const Failure& failure) const {
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

// ---- the link -----------------------------------------------------------------------------------

// What the interface says of itself now. An interface without a carrier is a controller that is
// off the bus.
void SocketCanBus::read_link() {
  const int flags = calls_.interface_flags(fd_, interface_.c_str());
  link_ = flags < 0 ? Link::kGone : (flags & IFF_UP) != 0 ? Link::kUp : Link::kDown;
  has_carrier_ = flags >= 0 && (flags & IFF_RUNNING) != 0;
  if (link_ == Link::kUp) health_.restart(has_carrier_);
}

bool SocketCanBus::is_up(TimePoint now) {
  if (link_ == Link::kUp) {
    if (health_.state() == BusState::kOff) check_carrier(now);
    return true;
  }
  if (now < next_look_) return false;
  const int index = calls_.interface_index(fd_, interface_.c_str());
  if (index == index_ && link_ == Link::kDown) {
    read_link();
    look_later(kLookPeriod, now);
  } else if (index < 0 || open_socket().step != Step::kDone) {
    link_ = Link::kGone;
    backoff_ = std::clamp(backoff_ * 2, kLookPeriod, kLongestBackoff);
    look_later(backoff_, now);
  } else {
    backoff_ = {};
    look_later(kLookPeriod, now);
  }
  return link_ == Link::kUp;
}

// The error frame that tells of the restart can get lost; the carrier that comes back cannot.
void SocketCanBus::check_carrier(TimePoint now) {
  if (now < next_look_) return;
  look_later(kLookPeriod, now);
  const int flags = calls_.interface_flags(fd_, interface_.c_str());
  if (flags < 0) return;
  const bool has_carrier = (flags & IFF_RUNNING) != 0;
  if (has_carrier && !has_carrier_) health_.restart(true);
  has_carrier_ = has_carrier;
}

void SocketCanBus::note_error(int error, TimePoint now) {
  if (!is_link_error(error)) return;  // no room, or interrupted: the next cycle tries again
  if (link_ == Link::kUp) ++counters_.links_lost;
  // What is down is looked at in the next call at the earliest, so that a loss, however short, is
  // seen by whoever asks for the state.
  if (link_ != Link::kGone) link_ = error == ENETDOWN ? Link::kDown : Link::kGone;
  look_later(kLookPeriod, now);
}

// ---- frames -------------------------------------------------------------------------------------

int SocketCanBus::send(std::span<const CanFrame> frames, TimePoint now) {
  std::size_t taken = 0;
  if (is_up(now) && health_.state() != BusState::kOff) {
    while (taken < frames.size()) {
      const std::size_t count = std::min<std::size_t>(kBatch, frames.size() - taken);
      const int sent = send_some(frames.subspan(taken, count), now);
      taken += static_cast<std::size_t>(sent);
      if (sent < static_cast<int>(count)) break;
    }
  }
  counters_.sent += taken;
  counters_.send_refused += frames.size() - taken;
  return static_cast<int>(taken);
}

int SocketCanBus::send_some(std::span<const CanFrame> frames, TimePoint now) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    wires_[i] = to_wire(frames[i]);
    messages_[i].msg_hdr.msg_control = nullptr;
    messages_[i].msg_hdr.msg_controllen = 0;
  }
  const int sent = calls_.send_batch(fd_, messages_.data(), static_cast<unsigned>(frames.size()));
  if (sent < 0) note_error(-sent, now);
  return std::max(sent, 0);
}

int SocketCanBus::receive(std::span<ReceivedCanFrame> frames, TimePoint now) {
  std::size_t filled = 0;
  // Error frames fill nothing but cost a read: the bound keeps the call's time bounded.
  std::size_t reads = 2 * frames.size() + 2 * kBatch;
  while (filled < frames.size() && reads > 0 && is_up(now)) {
    const std::size_t count = std::min({std::size_t{kBatch}, frames.size() - filled, reads});
    const TimePoint before = monotonic();
    const std::size_t n = receive_batch(count, now);
    filled += hand_out(n, frames.subspan(filled), now);
    reads -= count;
    if (n == count) continue;
    emptied_ = before;
    break;
  }
  counters_.received += filled;
  return static_cast<int>(filled);
}

std::size_t SocketCanBus::receive_batch(std::size_t count, TimePoint now) {
  for (std::size_t i = 0; i < count; ++i) {
    messages_[i].msg_hdr.msg_control = controls_[i].bytes.data();
    messages_[i].msg_hdr.msg_controllen = controls_[i].bytes.size();
  }
  const int n = calls_.receive_batch(fd_, messages_.data(), static_cast<unsigned>(count));
  if (n < 0) note_error(-n, now);
  return static_cast<std::size_t>(std::max(n, 0));
}

// Returns how many of the n messages were data frames.
std::size_t SocketCanBus::hand_out(std::size_t n, std::span<ReceivedCanFrame> frames,
                                   TimePoint now) {
  if (n == 0) return 0;
  // Both clocks after the frames: no stamp can be later.
  const Duration realtime(calls_.clock_ns(CLOCK_REALTIME));
  const TimePoint monotonic_now = monotonic();
  const Clocks clocks = {monotonic_now, realtime - monotonic_now.time_since_epoch()};
  std::size_t filled = 0;
  for (std::size_t i = 0; i < n; ++i) {
    ReceivedCanFrame& received = frames[filled];
    received.time = read_control(messages_[i].msg_hdr, clocks, now);
    const bool is_whole =
        (messages_[i].msg_hdr.msg_flags & MSG_TRUNC) == 0 && messages_[i].msg_len <= kCanWireBytes;
    if (!is_whole || !from_wire(std::span(wires_[i]).first(messages_[i].msg_len), received.frame)) {
      ++counters_.malformed;
    } else if (received.frame.error) {
      health_.take(received.frame, counters_);
    } else {
      ++filled;
    }
  }
  return filled;
}

// Notes how many frames the socket had to drop; returns the frame's time.
TimePoint SocketCanBus::read_control(msghdr& message, const Clocks& clocks, TimePoint now) {
  TimePoint time = now;
  for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c)) {
    if (c->cmsg_level != SOL_SOCKET) continue;
    if (c->cmsg_type == SCM_TIMESTAMPNS && c->cmsg_len >= CMSG_LEN(sizeof(timespec))) {
      timespec stamp;
      std::memcpy(&stamp, CMSG_DATA(c), sizeof stamp);
      time = time_of(Duration(stamp.tv_sec * std::int64_t{1'000'000'000} + stamp.tv_nsec), clocks,
                     now);
    } else if (c->cmsg_type == SO_RXQ_OVFL && c->cmsg_len >= CMSG_LEN(sizeof(std::uint32_t))) {
      std::uint32_t dropped;  // since the socket was made; it may wrap round
      std::memcpy(&dropped, CMSG_DATA(c), sizeof dropped);
      counters_.receive_dropped += static_cast<std::uint32_t>(dropped - socket_drops_);
      socket_drops_ = dropped;
    }
  }
  return time;
}

TimePoint SocketCanBus::time_of(Duration stamp, const Clocks& clocks, TimePoint now) {
  const TimePoint time = TimePoint(stamp - clocks.realtime_offset);
  if (time <= clocks.monotonic + kStampSlack && time >= emptied_ - kStampSlack) {
    return std::min(time, clocks.monotonic);
  }
  ++counters_.clock_steps;
  return now;
}

}  // namespace gannet::hal
