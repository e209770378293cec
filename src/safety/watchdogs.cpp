#include "src/safety/watchdogs.hpp"

#include <algorithm>

namespace gannet::safety {

void AgeWatch::feed(TimePoint time) {
  newest_ = fed_ ? std::max(newest_, time) : time;
  fed_ = true;
}

Duration AgeWatch::age(TimePoint now) const { return fed_ ? now - newest_ : Duration::max(); }

bool AgeWatch::fresh(TimePoint now) {
  const bool is_fresh = fed_ && now - newest_ <= limit_;
  if (was_fresh_ && !is_fresh) ++lapses_;
  was_fresh_ = is_fresh;
  return is_fresh;
}

void OverrunWatch::advance(TimePoint now) {
  const std::int64_t part = now.time_since_epoch() / std::max(part_, Duration(1));
  const std::int64_t steps = std::clamp<std::int64_t>(part - newest_part_, 0, kParts);
  for (std::int64_t i = 1; i <= steps; ++i) {
    counts_[(part - steps + i) % kParts] = 0;
  }
  newest_part_ = std::max(part, newest_part_);
}

bool LimitWatch::exceeded(bool over, TimePoint now) {
  if (over && !over_) since_ = now;
  over_ = over;
  return over_ && now - since_ > patience_;
}

void OverrunWatch::note(int missed, TimePoint now) {
  advance(now);
  counts_[newest_part_ % kParts] += missed;
  total_ += static_cast<std::uint64_t>(missed);
}

bool OverrunWatch::exceeded(TimePoint now) {
  advance(now);
  int sum = 0;
  for (const int count : counts_) sum += count;
  return sum >= limit_;
}

}  // namespace gannet::safety
