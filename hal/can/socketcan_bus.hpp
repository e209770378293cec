// SocketCanBus: a CAN interface of Linux (can0, vcan0) through a raw socket, kind "socketcan".
// Data frames of exactly the wanted ids are handed out; the controller's error frames become
// state() and counters() and are not. Own frames do not come back; other programs on this machine
// see them (candump).
//
// Times are the kernel's stamps at arrival, on CLOCK_REALTIME, turned into monotonic ones by an
// offset that is read with each batch. A stamp in the future, or from before the socket was last
// seen empty, was spoiled by a step of the wall clock: then it is the time of receipt, counted.
//
// An interface that goes down is kDown until it is up again; one that is taken away is looked for
// by name, after 10 ms and then ever later up to 0.5 s, and opened anew. Nothing ever waits for the
// bus. Opening anew asks for the kernel's network lock, which `ip link` may hold for moments;
// nothing is allowed to move then. Frames offered while the bus is off or down are refused, so that
// no old setpoint waits in a queue for its return. While a bus is up but takes nothing (held up by
// others, nobody confirms), most_waiting frames wait in the interface's queue, those that the
// controller holds beside them, and what comes then is refused and counted: EAGAIN where the
// socket's send buffer is the limit, ENOBUFS where the interface's txqueuelen is. The send buffer
// counts a frame until the driver takes it (its echo is charged to nobody), so a queue that
// somebody made long for other programs makes ours no longer.
//
// CAN FD would be a kind beside this one: its frames have another size and flags.
// Created at start-up; then one thread, RT safe.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "hal/can/bus_health.hpp"
#include "hal/can/can_bus.hpp"
#include "hal/can/can_socket.hpp"
#include "platform/base/result.hpp"

namespace gannet::hal {

class SocketCanBus final : public CanBus {
 public:
  // wanted: empty means all. most_waiting: see above; 0: as many as the kernel likes, and it grants
  // 6 at least. An interface that is down is accepted: the bus begins as kDown.
  // Error: no such interface, none of CAN, a kernel without CAN, too many filters; what to do.
  static Result<std::unique_ptr<SocketCanBus>> open(const std::string& interface,
                                                    const std::vector<CanFilter>& wanted,
                                                    int most_waiting, TimePoint now,
                                                    CanCalls& calls = linux_can_calls());

  int send(std::span<const CanFrame> frames, TimePoint now) override;
  int receive(std::span<ReceivedCanFrame> frames, TimePoint now) override;
  BusState state() const override { return link_ == Link::kUp ? health_.state() : BusState::kDown; }
  CanCounters counters() const override;
  int fd() const {
    return socket_.fd();
  }  // for a wait (poll); another one after the interface was away

 private:
  enum class Link : std::uint8_t { kUp, kDown, kGone };
  struct Clocks {
    TimePoint monotonic;
    Duration realtime_offset;
  };

  SocketCanBus(const std::string& interface, const std::vector<CanFilter>& wanted, int most_waiting,
               CanCalls& calls)
      : calls_(calls), socket_(interface, wanted, most_waiting, calls) {}
  CanSocket::Failure open_socket();
  void read_link();
  bool is_up(TimePoint now);
  void check_carrier(TimePoint now);
  void note_error(int error, TimePoint now);
  std::size_t hand_out(std::span<const CanArrival> arrivals, std::span<ReceivedCanFrame> frames,
                       TimePoint now);
  TimePoint time_of(Duration stamp, const Clocks& clocks, TimePoint now);
  TimePoint monotonic() { return time_from_ns(calls_.clock_ns(CLOCK_MONOTONIC)); }

  CanCalls& calls_;
  CanSocket socket_;
  Link link_ = Link::kGone;
  bool has_carrier_ = true;
  Duration backoff_ = {};
  TimePoint next_look_ = {};
  TimePoint emptied_ = {};  // when the socket was last known to hold no frame
  BusHealth health_;
  CanCounters counters_;
  std::array<CanArrival, CanSocket::kBatch> arrivals_ = {};
};

}  // namespace gannet::hal
