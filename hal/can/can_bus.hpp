// CanBus: sends and receives frames without ever blocking. Kinds: memory, local (AF_UNIX);
// SocketCAN beside them. Created at start-up by make_can_bus (can_kinds.hpp); used by the servo
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
  std::uint64_t receive_dropped = 0;  // lost before we read them
  std::uint64_t malformed = 0;
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
