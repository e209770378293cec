#include "hal/camera/replay_camera.hpp"

#include <algorithm>
#include <utility>

#include "platform/base/log.hpp"
#include "platform/linux/clock.hpp"

namespace gannet::hal {

Result<std::unique_ptr<StereoCamera>> ReplayCamera::create(const ReplayCameraConfig& config,
                                                           DecodeImage decode, Pace pace) {
  auto source = ReplaySource::open(config.directory, config.rate_hz, config.loop, decode);
  if (!source) return source.error();
  return std::unique_ptr<StereoCamera>(new ReplayCamera(std::move(*source), config.slots, pace));
}

ReplayCamera::ReplayCamera(ReplaySource source, int slots, Pace pace)
    : source_(std::move(source)),
      pace_(pace),
      pairs_(static_cast<std::size_t>(slots)),
      pool_(slots),
      loaded_(slots) {}

ReplayCamera::~ReplayCamera() {
  stop_.store(1, std::memory_order_release);
  linux_os::futex_wake_all(stop_);
  decoder_.join();
}

Result<void> ReplayCamera::start() {
  if (pace_ == Pace::kStepped) return {};
  auto thread = linux_os::Thread::start("replay", {}, [this] { decode_ahead(); });
  if (!thread) return thread.error();
  decoder_ = std::move(*thread);
  return {};
}

TimePoint ReplayCamera::due(std::uint64_t index) const {
  return time_from_ns(origin_ns_.load(std::memory_order_relaxed)) + source_.due(index);
}

ReplayCamera::Loaded ReplayCamera::load(Lease lease, std::uint64_t index) {
  const auto result = source_.load(index, pairs_[static_cast<std::size_t>(lease.slot())]);
  // Later laps would only repeat it.
  if (!result && index < source_.pairs()) log(Severity::kWarning, result.error().text);
  return {std::move(lease), index, !result};
}

// ---- capture thread
// ------------------------------------------------------------------------------

CaptureStatus ReplayCamera::capture(TimePoint now, Duration timeout, StereoFrame& frame) {
  // Relaxed: the decoder only wants to know it sooner or later.
  if (origin_ns_.load(std::memory_order_relaxed) < 0)
    origin_ns_.store(to_ns(now), std::memory_order_relaxed);
  return pace_ == Pace::kStepped ? capture_stepped(now, frame)
                                 : capture_live(now, now + timeout, frame);
}

CaptureStatus ReplayCamera::deliver(Loaded loaded, StereoFrame& frame) {
  if (loaded.broken) {
    ++counters_.broken;
    return CaptureStatus::kBroken;
  }
  const ReplayPair& pair = pairs_[static_cast<std::size_t>(loaded.lease.slot())];
  frame.left = pair.left.view();
  frame.right = pair.right.view();
  frame.capture_time = due(loaded.index);
  frame.number = loaded.index + 1;
  frame.left_lease = std::move(loaded.lease);
  frame.right_lease = Lease{};
  ++counters_.frames;
  return CaptureStatus::kFrame;
}

CaptureStatus ReplayCamera::capture_stepped(TimePoint now, StereoFrame& frame) {
  if (!source_.has(next_)) return CaptureStatus::kFinished;
  if (due(next_) > now) return CaptureStatus::kNothing;
  const std::uint64_t index = next_++;
  Lease lease = pool_.lend();
  if (lease.valid()) return deliver(load(std::move(lease), index), frame);
  ++counters_.dropped;
  return CaptureStatus::kNoSlot;
}

CaptureStatus ReplayCamera::capture_live(TimePoint now, TimePoint deadline, StereoFrame& frame) {
  for (;;) {
    // The usual order against a lost wake-up: read the word, look, then sleep.
    const std::uint32_t news = news_.load(std::memory_order_acquire);
    const bool ended = ended_.load(std::memory_order_acquire);
    if (!pending_.lease.valid() && !loaded_.pop(pending_) && ended) return CaptureStatus::kFinished;
    const bool has_one = pending_.lease.valid();
    if (has_one && due(pending_.index) <= now)
      return deliver(std::exchange(pending_, Loaded{}), frame);
    if (now >= deadline) return CaptureStatus::kNothing;
    linux_os::futex_wait(news_, news, has_one ? std::min(due(pending_.index), deadline) : deadline);
    now = linux_os::monotonic_now();
  }
}

CaptureCounters ReplayCamera::counters() const {
  CaptureCounters counters = counters_;
  counters.dropped += skipped_.load(std::memory_order_relaxed);
  return counters;
}

// ---- decoder thread
// ------------------------------------------------------------------------------

bool ReplayCamera::is_too_late(std::uint64_t index) const {
  return origin_ns_.load(std::memory_order_relaxed) >= 0 &&
         due(index) + source_.interval() < linux_os::monotonic_now();
}

// Slots come home without a signal (that would cost their holders a system call): we look again
// at a fraction of the pairs' distance. Invalid when the camera ends.
Lease ReplayCamera::wait_for_slot() {
  const Duration pause = std::clamp<Duration>(source_.interval() / 4, std::chrono::milliseconds(1),
                                              std::chrono::milliseconds(20));
  for (;;) {
    if (stop_.load(std::memory_order_acquire) != 0) return {};
    Lease lease = pool_.lend();
    if (lease.valid()) return lease;
    linux_os::futex_wait(stop_, 0, linux_os::monotonic_now() + pause);
  }
}

void ReplayCamera::decode_ahead() {
  for (std::uint64_t index = 0; source_.has(index); ++index) {
    Lease lease = wait_for_slot();
    if (!lease.valid()) return;
    if (is_too_late(index)) {
      skipped_.fetch_add(1, std::memory_order_relaxed);
      continue;
    }
    // Never full: it has room for every slot, and each element holds one.
    loaded_.push(load(std::move(lease), index));
    news_.fetch_add(1, std::memory_order_release);
    linux_os::futex_wake_all(news_);
  }
  ended_.store(true, std::memory_order_release);
  news_.fetch_add(1, std::memory_order_release);
  linux_os::futex_wake_all(news_);
}

}  // namespace gannet::hal
