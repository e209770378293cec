// The socket of stepped time. The world listens and sends `step <t_ns>\n`; the daemon connects,
// runs everything that is due at t to completion and answers `done <t_ns>\n`. Its CAN frames and
// lines are out before the answer. One message a packet (SOCK_SEQPACKET). A peer that goes away
// is a stop. Main threads.
#pragma once

#include <string>

#include "platform/base/result.hpp"
#include "platform/base/time.hpp"
#include "platform/linux/unix_socket.hpp"

namespace gannet::linux_os {

// The world's end.
class StepServer {
 public:
  static Result<StepServer> listen(const std::string& name);
  // Waits for the daemon to connect. Error: it did not within the time-out.
  Result<void> wait_for_daemon(Duration timeout);
  // One step, all of it. Error: the daemon has gone, answered wrongly or not within the time-out.
  Result<void> step(TimePoint t, Duration timeout);

 private:
  UnixListener listener_;
  UnixSocket daemon_;
};

// The daemon's end.
class StepClient {
 public:
  // Tries until the world listens. Error: it did not within the time-out.
  static Result<StepClient> connect(const std::string& name, Duration timeout);

  enum class Status { kStep, kNothing, kMalformed, kGone };
  // Waits at most until the time-out for the next step. Malformed ones are to be counted.
  Status receive(TimePoint& t, Duration timeout);
  bool answer_done(TimePoint t);  // false: the world has gone
  int fd() const { return world_.fd(); }

 private:
  UnixSocket world_;
};

}  // namespace gannet::linux_os
