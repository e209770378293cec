#include "hal/camera/v4l2_judge.hpp"

#include <utility>

namespace gannet::hal {
namespace {

// Stamps ahead of our clock: vivid gives up to one frame's time (34 ms seen), a driver's own
// clock drifts a little. Behind: frames that waited in the driver while nobody fetched them.
constexpr Duration kMostAhead = std::chrono::milliseconds(100);
constexpr Duration kMostBehind = std::chrono::seconds(1);
// A jump beyond is a new numbering, not frames lost.
constexpr std::uint32_t kMostMissed = 1000;
// Seconds beyond do not fit into nanoseconds.
constexpr std::int64_t kMostSeconds = 9'000'000'000;

}  // namespace

V4l2Fault V4l2Judge::judge(const v4l2_buffer& buffer, TimePoint now) {
  count_missed(buffer.sequence);
  if ((buffer.flags & V4L2_BUF_FLAG_ERROR) != 0) return V4l2Fault::kErrorFlag;
  if (buffer.bytesused < least_bytes_ || buffer.bytesused == 0) return V4l2Fault::kShort;
  return judge_stamp(buffer, now);
}

// Unsigned, so that the wrap at 2³² is a step like any other. A number that repeats, goes back or
// jumps far tells nothing (v4l2loopback: always 0 for some writers). Nor does a step from 0: that
// is what v4l2loopback says until the writer's next frame comes.
void V4l2Judge::count_missed(std::uint32_t sequence) {
  const std::uint32_t last = std::exchange(sequence_, sequence);
  const std::uint32_t step = sequence - last;
  missed_ = last != 0 && step >= 2 && step <= kMostMissed ? step - 1 : 0;
}

V4l2Fault V4l2Judge::judge_stamp(const v4l2_buffer& buffer, TimePoint now) {
  const std::uint32_t clock = buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK;
  const bool is_ours = clock == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC ||
                       (any_clock_ && clock == V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN);
  const std::int64_t seconds = buffer.timestamp.tv_sec;
  if (!is_ours || seconds < 0 || seconds > kMostSeconds) return V4l2Fault::kOffClock;
  stamp_ = time_from_ns(seconds * 1'000'000'000 +
                        std::int64_t{buffer.timestamp.tv_usec} % 1'000'000 * 1000);
  if (newest_ != TimePoint{} && stamp_ == newest_) return V4l2Fault::kFrozen;
  if (stamp_ < newest_) return V4l2Fault::kBackward;
  if (stamp_ > now + kMostAhead || stamp_ < now - kMostBehind) return V4l2Fault::kOffClock;
  newest_ = stamp_;
  return V4l2Fault::kNone;
}

void count(V4l2Fault fault, CaptureCounters& counters) {
  if (fault == V4l2Fault::kNone) return;
  ++counters.broken;
  ++(fault == V4l2Fault::kErrorFlag  ? counters.error_flagged
     : fault == V4l2Fault::kShort    ? counters.short_frames
     : fault == V4l2Fault::kFrozen   ? counters.frozen
     : fault == V4l2Fault::kBackward ? counters.backward
                                     : counters.off_clock);
}

}  // namespace gannet::hal
