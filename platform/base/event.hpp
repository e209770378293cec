// Events: what a real-time thread has to tell people, as a small value without text. Each thread
// raises into its own EventPort (a ring); the control thread takes them out, gives them their
// words and tells log and clients. Codes and their words are listed by src/telemetry.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "platform/base/ring.hpp"
#include "platform/base/time.hpp"

namespace gannet {

// The numbers are those of syslog and sd-daemon.
enum class Severity : std::uint8_t {
  kCritical = 2,
  kError = 3,
  kWarning = 4,
  kNotice = 5,
  kInfo = 6,
  kDebug = 7,
};

enum class EventCode : std::uint16_t {};  // src/telemetry/event_codes.hpp has them all

struct Event {
  EventCode code = {};
  Severity severity = Severity::kInfo;
  TimePoint time = {};
  std::array<double, 3> args = {};  // whole numbers are exact up to 2⁵³
};

// From one thread to the control thread. raise: owner thread, RT safe; take: control thread.
class EventPort {
 public:
  explicit EventPort(int capacity = 256) : ring_(capacity) {}

  void raise(const Event& event) {
    // Relaxed: a count, it orders nothing.
    if (!ring_.push(event)) lost_.fetch_add(1, std::memory_order_relaxed);
  }
  bool take(Event& event) { return ring_.pop(event); }
  std::uint64_t lost() const { return lost_.load(std::memory_order_relaxed); }

 private:
  SpscRing<Event> ring_;
  std::atomic<std::uint64_t> lost_{0};
};

}  // namespace gannet
