// A CAN bus over AF_UNIX sockets, where the kernel has no CAN: one message (SOCK_SEQPACKET) is one
// frame, in the bytes of SocketCAN (can_wire.hpp).
//
// LocalBus is a node. It connects to a hub; when the hub is absent or goes, the bus is kDown and
// send and receive try again, by time, first after 10 ms, then ever later up to once a second. It
// never blocks. Error frames, which only a simulated world sends, become state() and counters() as
// with a controller; while it is off the bus nothing is sent. Two nodes without a hub are a pair().
// Created at start-up; then RT safe.
//
// LocalCanHub is the server (the simulated world): it hears every node and passes each frame on to
// all the others, as a wire does. It is itself a node on that wire. Its thread alone; no memory is
// taken after creation.
#pragma once

#include <sys/un.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hal/can/bus_health.hpp"
#include "hal/can/can_bus.hpp"
#include "platform/base/fixed_vector.hpp"
#include "platform/base/result.hpp"
#include "platform/linux/unix_socket.hpp"

namespace gannet::hal {

// What became of an attempt to read or write one frame.
enum class LocalIo { kDone, kNothing, kMalformed, kClosed };
LocalIo send_frame(linux_os::UnixSocket& socket, const CanFrame& frame);
LocalIo receive_frame(linux_os::UnixSocket& socket, CanFrame& frame);

class LocalBus final : public CanBus {
 public:
  // name: a path, or '@' and an abstract name. Nobody there is no error: the bus is down until
  // somebody is. Frames that match no filter are dropped unseen; no filter: all are wanted.
  static Result<std::unique_ptr<LocalBus>> connect(const std::string& name, TimePoint now,
                                                   std::vector<CanFilter> filters = {});
  using Pair = std::pair<std::unique_ptr<LocalBus>, std::unique_ptr<LocalBus>>;
  static Result<Pair> pair();

  int send(std::span<const CanFrame> frames, TimePoint now) override;
  int receive(std::span<ReceivedCanFrame> frames, TimePoint now) override;
  BusState state() const override { return socket_.valid() ? health_.state() : BusState::kDown; }
  CanCounters counters() const override { return counters_; }
  std::uint64_t connections() const { return connections_; }

 private:
  LocalBus() = default;
  bool try_connect();
  bool is_up(TimePoint now);
  void go_down(TimePoint now);
  bool is_wanted(const CanFrame& frame) const;

  sockaddr_un address_ = {};
  socklen_t address_length_ = 0;  // 0: one of a pair, which cannot reconnect
  linux_os::UnixSocket socket_;
  std::vector<CanFilter> filters_;
  Duration backoff_ = {};
  TimePoint next_attempt_ = {};
  BusHealth health_;
  CanCounters counters_;
  std::uint64_t connections_ = 0;
};

class LocalCanHub final : public CanBus {
 public:
  static constexpr int kMaxNodes = 16;

  // Error: the name is served by another process, or cannot be made.
  static Result<std::unique_ptr<LocalCanHub>> listen(const std::string& name, unsigned mode = 0660);

  // To all nodes. True to a wire, a frame without a listener is sent too.
  int send(std::span<const CanFrame> frames, TimePoint now) override;
  // Takes newcomers in, then what the nodes sent, node by node in the order they came; each frame
  // also goes to the other nodes.
  int receive(std::span<ReceivedCanFrame> frames, TimePoint now) override;
  BusState state() const override { return BusState::kGood; }
  CanCounters counters() const override { return counters_; }
  int nodes() const { return nodes_.size(); }
  // For a wait (poll) until somebody connects or sends.
  int listener_fd() const { return listener_.fd(); }
  int node_fd(int index) const { return nodes_[index].fd(); }

 private:
  explicit LocalCanHub(linux_os::UnixListener listener) : listener_(std::move(listener)) {}
  void accept_newcomers();
  void distribute(const CanFrame& frame, int except);
  void remove_closed();

  linux_os::UnixListener listener_;
  FixedVector<linux_os::UnixSocket, kMaxNodes> nodes_;
  CanCounters counters_;
};

}  // namespace gannet::hal
