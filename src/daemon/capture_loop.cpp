#include "src/daemon/capture_loop.hpp"

#include <bit>
#include <utility>

#include "platform/linux/clock.hpp"
#include "src/telemetry/event_codes.hpp"

#include "platform/base/rt_only.hpp"

namespace gannet::daemon {

using hal::CaptureStatus;
using linux_os::monotonic_now;
using telemetry::make_event;

CaptureLoop::CaptureLoop(const Links& links, Duration time_offset)
    : links_(links), time_offset_(time_offset) {
  report_.loop.timer.name(kTake, "take");
  report_.loop.timer.name(kHandOn, "hand_on");
}

CaptureStatus CaptureLoop::step(TimePoint now, Duration timeout) {
  TakenFrame taken;
  auto& timer = report_.loop.timer;
  timer.begin(monotonic_now());
  const CaptureStatus status = links_.camera->capture(now, timeout, taken.frame);
  taken.taken = monotonic_now();
  timer.lap(kTake, taken.taken);
  if (status == CaptureStatus::kFrame) {
    hand_on(std::move(taken), now);
    timer.lap(kHandOn, monotonic_now());
  }
  tell(status, now);
  return status;
}

void CaptureLoop::hand_on(TakenFrame&& taken, TimePoint now) {
  taken.frame.capture_time += time_offset_;
  // Relaxed: a word of its own, it orders nothing.
  links_.facts->last_frame_ns.store(to_ns(now), std::memory_order_relaxed);
  // A frame that stays with us goes home when `taken` ends.
  if (!links_.to_vision->push(std::move(taken))) report_.not_taken += 1;
}

void CaptureLoop::tell(CaptureStatus status, TimePoint now) {
  const bool lost = status == CaptureStatus::kLost || status == CaptureStatus::kFinished;
  if (lost && !silent_) {
    links_.events->raise(make_event(
        status == CaptureStatus::kLost ? telemetry::kCameraSilent : telemetry::kReplayFinished,
        now));
    silent_ = true;
  } else if (silent_ && status == CaptureStatus::kFrame) {
    links_.events->raise(make_event(telemetry::kCameraBack, now));
    silent_ = false;
  }
  report_.status = status;
  report_.camera = links_.camera->counters();
  // Told at 1, 2, 4, 8 …: a camera that goes on doing it does not flood the log.
  const auto broken = report_.camera.broken;
  if (status == CaptureStatus::kBroken && std::has_single_bit(broken)) {
    links_.events->raise(make_event(telemetry::kCameraBroken, now, static_cast<double>(broken)));
  }
  const auto dropped = report_.camera.dropped;
  if (status == CaptureStatus::kNoSlot && std::has_single_bit(dropped)) {
    links_.events->raise(make_event(telemetry::kCameraNoSlot, now, static_cast<double>(dropped)));
  }
  report_.loop.cycles += 1;
  report_.loop.time = now;
  links_.report->write(report_);
  links_.facts->capture_cycles.store(report_.loop.cycles, std::memory_order_relaxed);
}

}  // namespace gannet::daemon
