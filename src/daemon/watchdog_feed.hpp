// WatchdogFeed: decides when the service manager may be told that all is well: only after the loops
// of capture, vision and servo have all moved since it was told last. A loop that waits for
// something that is lost moves too, by the time-out of its wait. Pure: time is an argument.
// Main thread.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "platform/base/time.hpp"

namespace gannet::daemon {

class WatchdogFeed {
 public:
  using Cycles = std::array<std::uint64_t, 3>;  // of capture, vision, servo

  enum class Say : std::uint8_t {
    kNothing,
    kAlive,  // tell the manager
    kStuck,  // once a standstill: half of the limit is over without all having moved
  };

  // limit: the manager ends us when it hears nothing for so long; 0: it does not want to hear.
  explicit WatchdogFeed(Duration limit) : limit_(limit) {}

  Say look(TimePoint now, const Cycles& cycles);

  // Names of the loops that have not moved since the manager was told last: "vision, servo".
  std::string standing_still() const;

 private:
  const Duration limit_;
  TimePoint told_ = {};  // none yet: the first look counts as one
  Cycles told_cycles_ = {};
  Cycles seen_ = {};
  bool complained_ = false;
};

}  // namespace gannet::daemon
