// FrameLine: frames from one loop to the next, with a doorbell to sleep by.
// push: one thread; pop and wait: one other. RT safe.
#pragma once

#include <utility>

#include "platform/base/ring.hpp"
#include "platform/linux/futex.hpp"
#include "src/daemon/messages.hpp"

namespace gannet::daemon {

class FrameLine {
 public:
  explicit FrameLine(int capacity) : ring_(capacity) {}

  // False: no room, the frame stays with the caller.
  bool push(TakenFrame&& frame) {
    if (!ring_.push(std::move(frame))) return false;
    wake();
    return true;
  }
  bool pop(TakenFrame& frame) { return ring_.pop(frame); }
  bool empty() const { return ring_.size() == 0; }

  // Sleeps until a frame is there, somebody rings, or the time has come.
  void wait(TimePoint until) const {
    const std::uint32_t seen = bell_.load(std::memory_order_acquire);
    if (empty()) linux_os::futex_wait(bell_, seen, until);
  }
  void wake() {
    // Release pairs with the acquire in wait(): who sees the new count sees the frame.
    bell_.fetch_add(1, std::memory_order_release);
    linux_os::futex_wake_all(bell_);
  }

 private:
  SpscRing<TakenFrame> ring_;
  linux_os::FutexWord bell_{0};
};

}  // namespace gannet::daemon
