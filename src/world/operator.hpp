// Operator: the person at the daemon's control socket, as a scenario has one: sends commands and
// reads the status. Each call waits for its answer, so that in stepped time a command is in the
// daemon before the next step. One thread.
#pragma once

#include <memory>
#include <string>

#include "platform/base/result.hpp"
#include "platform/base/time.hpp"
#include "src/control/client.hpp"
#include "src/world/action.hpp"
#include "src/world/trace.hpp"

namespace gannet::world {

class Operator {
 public:
  // Tries until the daemon serves its socket. Error: it did not within the time-out.
  static Result<Operator> connect(const std::string& socket, Duration timeout);

  // Error: the daemon refused, in its words.
  Result<void> command(const Action& action);
  // What the daemon says now. Error: no answer.
  Result<HeardEstimate> look(TimePoint start, Duration timeout = std::chrono::seconds(5));
  // Its timing and counters, for the record.
  Result<control::Json> top();

 private:
  explicit Operator(control::Client client) : client_(std::move(client)) {}
  control::Client client_;
};

// The parts of a status answer that a trace keeps; start is the run's beginning.
HeardEstimate heard_from(const control::Json& status, TimePoint start);

}  // namespace gannet::world
