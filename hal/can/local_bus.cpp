#include "hal/can/local_bus.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>

#include "hal/can/can_wire.hpp"

namespace gannet::hal {
namespace {

using linux_os::Fd;
using linux_os::IoResult;
using linux_os::IoStatus;
using linux_os::UnixSocket;
using std::chrono::milliseconds;

constexpr Duration kFirstBackoff = milliseconds(10), kLongestBackoff = milliseconds(1000);

}  // namespace

LocalIo send_frame(UnixSocket& socket, const CanFrame& frame) {
  const CanWire wire = to_wire(frame);
  switch (socket.send(std::as_bytes(std::span(wire))).status) {
    case IoStatus::kDone:
      return LocalIo::kDone;
    case IoStatus::kWouldBlock:
      return LocalIo::kNothing;
    default:
      return LocalIo::kClosed;
  }
}

LocalIo receive_frame(UnixSocket& socket, CanFrame& frame) {
  CanWire wire;
  const IoResult result = socket.receive(std::as_writable_bytes(std::span(wire)));
  switch (result.status) {
    case IoStatus::kDone:
      return from_wire(std::span(wire).first(result.size), frame) ? LocalIo::kDone
                                                                  : LocalIo::kMalformed;
    case IoStatus::kTooLong:
      return LocalIo::kMalformed;
    case IoStatus::kWouldBlock:
      return LocalIo::kNothing;
    default:
      return LocalIo::kClosed;
  }
}

// ---- LocalBus -----------------------------------------------------------------------------------

Result<std::unique_ptr<LocalBus>> LocalBus::connect(const std::string& name, TimePoint now,
                                                    std::vector<CanFilter> filters) {
  std::unique_ptr<LocalBus> bus(new LocalBus);
  const std::size_t room = sizeof bus->address_.sun_path;
  if (name.empty() || name.size() >= room) {
    return Error{"local CAN bus '" + name + "': the socket's name must have 1 to " +
                 std::to_string(room - 1) + " bytes"};
  }
  bus->address_.sun_family = AF_UNIX;
  std::memcpy(bus->address_.sun_path, name.data(), name.size());
  const bool is_abstract = name[0] == '@';
  if (is_abstract) bus->address_.sun_path[0] = '\0';
  bus->address_length_ =
      static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size() + (is_abstract ? 0 : 1));
  bus->filters_ = std::move(filters);
  if (!bus->try_connect()) bus->go_down(now);
  return bus;
}

Result<LocalBus::Pair> LocalBus::pair() {
  int fds[2];
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, fds) != 0) {
    return linux_os::system_error("local CAN bus: socketpair", errno);
  }
  Pair pair{new LocalBus, new LocalBus};
  pair.first->socket_ = UnixSocket(Fd(fds[0]));
  pair.second->socket_ = UnixSocket(Fd(fds[1]));
  return pair;
}

// Not UnixSocket::connect: that one makes an error's text, which takes memory.
bool LocalBus::try_connect() {
  Fd fd(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!fd.valid()) return false;
  if (::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address_), address_length_) != 0) {
    return false;
  }
  socket_ = UnixSocket(std::move(fd));
  backoff_ = {};
  health_.restart(true);
  ++connections_;
  return true;
}

bool LocalBus::is_up(TimePoint now) {
  if (socket_.valid()) return true;
  if (address_length_ == 0 || now < next_attempt_) return false;
  if (try_connect()) return true;
  go_down(now);
  return false;
}

void LocalBus::go_down(TimePoint now) {
  socket_.close();
  backoff_ = std::clamp(backoff_ * 2, kFirstBackoff, kLongestBackoff);
  next_attempt_ = now + backoff_;
}

bool LocalBus::is_wanted(const CanFrame& frame) const {
  return filters_.empty() ||
         std::any_of(filters_.begin(), filters_.end(),
                     [&](const CanFilter& filter) { return filter.matches(frame); });
}

int LocalBus::send(std::span<const CanFrame> frames, TimePoint now) {
  int taken = 0;
  if (is_up(now) && health_.state() != BusState::kOff) {
    for (const CanFrame& frame : frames) {
      const LocalIo io = send_frame(socket_, frame);
      if (io == LocalIo::kClosed) go_down(now);
      if (io != LocalIo::kDone) break;
      ++taken;
    }
  }
  counters_.sent += static_cast<std::uint64_t>(taken);
  counters_.send_refused += frames.size() - static_cast<std::size_t>(taken);
  return taken;
}

int LocalBus::receive(std::span<ReceivedCanFrame> frames, TimePoint now) {
  if (!is_up(now)) return 0;
  std::size_t filled = 0;
  // Unwanted and malformed frames cost a read too: the bound keeps the call's time bounded.
  for (std::size_t reads = 0; filled < frames.size() && reads < 2 * frames.size() + 64; ++reads) {
    const LocalIo io = receive_frame(socket_, frames[filled].frame);
    if (io == LocalIo::kClosed) go_down(now);
    if (io == LocalIo::kClosed || io == LocalIo::kNothing) break;
    if (io == LocalIo::kMalformed) {
      ++counters_.malformed;
    } else if (frames[filled].frame.error) {
      health_.take(frames[filled].frame, counters_);
    } else if (is_wanted(frames[filled].frame)) {
      frames[filled++].time = now;
    }
  }
  counters_.received += filled;
  return static_cast<int>(filled);
}

// ---- LocalCanHub --------------------------------------------------------------------------------

Result<std::unique_ptr<LocalCanHub>> LocalCanHub::listen(const std::string& name, unsigned mode) {
  auto listener = linux_os::UnixListener::listen(name, linux_os::SocketKind::kSeqPacket, mode);
  if (!listener) return listener.error();
  return std::unique_ptr<LocalCanHub>(new LocalCanHub(std::move(*listener)));
}

int LocalCanHub::send(std::span<const CanFrame> frames, TimePoint) {
  accept_newcomers();
  for (const CanFrame& frame : frames) distribute(frame, -1);
  remove_closed();
  counters_.sent += frames.size();
  return static_cast<int>(frames.size());
}

int LocalCanHub::receive(std::span<ReceivedCanFrame> frames, TimePoint now) {
  accept_newcomers();
  std::size_t filled = 0;
  for (int node = 0; node < nodes_.size(); ++node) {
    while (filled < frames.size() && nodes_[node].valid()) {
      const LocalIo io = receive_frame(nodes_[node], frames[filled].frame);
      if (io == LocalIo::kClosed) nodes_[node].close();
      if (io == LocalIo::kClosed || io == LocalIo::kNothing) break;
      if (io == LocalIo::kMalformed) {
        ++counters_.malformed;
        continue;
      }
      distribute(frames[filled].frame, node);
      frames[filled++].time = now;
    }
  }
  remove_closed();
  counters_.received += filled;
  return static_cast<int>(filled);
}

void LocalCanHub::accept_newcomers() {
  while (!nodes_.full()) {
    auto newcomer = listener_.accept();
    if (!newcomer) return;
    nodes_.push_back(std::move(*newcomer));
  }
}

void LocalCanHub::distribute(const CanFrame& frame, int except) {
  for (int node = 0; node < nodes_.size(); ++node) {
    if (node == except || !nodes_[node].valid()) continue;
    const LocalIo io = send_frame(nodes_[node], frame);
    if (io == LocalIo::kClosed) nodes_[node].close();
    if (io != LocalIo::kDone) ++counters_.send_refused;  // that node alone missed it
  }
}

void LocalCanHub::remove_closed() {
  int kept = 0;
  for (int node = 0; node < nodes_.size(); ++node) {
    if (!nodes_[node].valid()) continue;
    if (kept != node) nodes_[kept] = std::move(nodes_[node]);
    ++kept;
  }
  nodes_.truncate(kept);
}

}  // namespace gannet::hal
