// CanBus: sends and receives frames without ever blocking. Kinds: memory, local (AF_UNIX),
// socketcan. Created at start-up by make_can_bus (can_kinds.hpp); used by the servo
// thread alone.
#pragma once

#include <cstdint>
#include <span>

#include "hal/can/can_frame.hpp"
#include "platform/base/time.hpp"

namespace gannet::hal {

struct ReceivedCanFrame {
  CanFrame frame;
  TimePoint time;  // of receipt, the kernel's stamp where there is one
};

enum class BusState : std::uint8_t { kGood, kWarning, kPassive, kOff, kDown };

struct CanCounters {
  std::uint64_t sent = 0;
  std::uint64_t received = 0;
  std::uint64_t send_refused = 0;     // no room, or the bus is down
  std::uint64_t send_no_room = 0;     // of these: the bus was up, but older frames still waited
  std::uint64_t receive_dropped = 0;  // lost before we read them
  std::uint64_t malformed = 0;
  // Of buses with a controller that tells:
  std::uint64_t error_frames = 0;
  std::uint64_t no_ack = 0;          // sent, and nobody on the bus confirmed it
  std::uint64_t bus_off = 0;         // the controller went off the bus
  std::uint64_t restarts = 0;        // and came back
  std::uint64_t links_lost = 0;      // the interface went down or away
  std::uint64_t clock_steps = 0;     // frames whose stamp a step of the wall clock had spoiled
  std::uint8_t transmit_errors = 0;  // the controller's own counters, when it last told
  std::uint8_t receive_errors = 0;
};

class CanBus {
 public:
  virtual ~CanBus() = default;

  // Returns how many of the frames were taken, from the first; the rest is counted as refused.
  // RT safe.
  virtual int send(std::span<const CanFrame> frames, TimePoint now) = 0;

  // Fills up to frames.size() frames that have arrived; returns how many. RT safe.
  virtual int receive(std::span<ReceivedCanFrame> frames, TimePoint now) = 0;

  virtual BusState state() const = 0;
  virtual CanCounters counters() const = 0;
};

}  // namespace gannet::hal
