#include "src/daemon/watchdog_feed.hpp"

#include <algorithm>
#include <functional>

namespace gannet::daemon {

WatchdogFeed::Say WatchdogFeed::look(TimePoint now, const Cycles& cycles) {
  if (limit_.count() == 0) return Say::kNothing;
  if (told_ == TimePoint{}) told_ = now;
  seen_ = cycles;
  const Duration silent = now - told_;
  if (silent < limit_ / 3) return Say::kNothing;
  const bool all_moved =
      std::equal(seen_.begin(), seen_.end(), told_cycles_.begin(), std::not_equal_to<>());
  if (all_moved) {
    told_ = now;
    told_cycles_ = seen_;
    complained_ = false;
    return Say::kAlive;
  }
  if (complained_ || silent < limit_ / 2) return Say::kNothing;
  complained_ = true;
  return Say::kStuck;
}

std::string WatchdogFeed::standing_still() const {
  static constexpr std::array<const char*, 3> kNames = {"capture", "vision", "servo"};
  std::string names;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    if (seen_[i] == told_cycles_[i]) names += (names.empty() ? "" : ", ") + std::string(kNames[i]);
  }
  return names;
}

}  // namespace gannet::daemon
