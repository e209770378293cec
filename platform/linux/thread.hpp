// Threads of the daemon: named, pinned to a core, of a FIFO priority, with a stack of fixed size
// that is touched beforehand. Without the rights to one of these a thread runs on without it;
// what was refused is told once, by rights_note(). Start-up only; move-only, joined at the end.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "platform/base/describe.hpp"
#include "platform/base/result.hpp"

namespace gannet::linux_os {

struct ThreadConfig {
  int core = -1;     // −1: any
  int priority = 0;  // FIFO 1 … 99; 0: normal scheduling
};
void describe(Visitor& v, ThreadConfig& c);

class Thread {
 public:
  // name: at most 15 letters. body runs on the new thread until it returns.
  static Result<Thread> start(const std::string& name, const ThreadConfig& config,
                              std::function<void()> body);
  Thread();
  Thread(Thread&& other) noexcept;
  Thread& operator=(Thread&& other) noexcept;
  ~Thread();
  void join();
  bool running() const { return body_ != nullptr; }

 private:
  struct Body;
  std::unique_ptr<Body> body_;
};

// Locks all memory of the process, now and in future, so that nothing is paged out. Where the
// limit does not allow it, memory stays unlocked and rights_note() says so.
bool lock_memory();

// Touches the first 256 KiB of the calling thread's stack. RT safe.
void prefault_stack();

// What real-time rights the process lacks, in words for the log; empty: nothing was refused since
// the last call.
std::string rights_note();

}  // namespace gannet::linux_os
