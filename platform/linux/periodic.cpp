#include "platform/linux/periodic.hpp"

#include <cerrno>

#include "platform/linux/clock.hpp"

namespace gannet::linux_os {

Periodic::Wake Periodic::plan(TimePoint now) {
  Wake wake{.due = next_};
  // Being late by less than a period still serves the period; beyond, whole ones are gone.
  if (now - next_ >= period_) {
    wake.missed = (now - next_) / period_;
    wake.due = next_ + wake.missed * period_;
    overruns_ += static_cast<std::uint64_t>(wake.missed);
  }
  next_ = wake.due + period_;
  return wake;
}

Periodic::Wake Periodic::wait() {
  Wake wake = plan(monotonic_now());
  const std::int64_t ns = to_ns(wake.due);
  const timespec until = {static_cast<time_t>(ns / 1'000'000'000),
                          static_cast<long>(ns % 1'000'000'000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
  wake.late = monotonic_now() - wake.due;
  return wake;
}

}  // namespace gannet::linux_os
