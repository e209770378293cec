#include "hal/camera/simulated_camera.hpp"

#include <algorithm>
#include <utility>

#include "platform/base/log.hpp"
#include "platform/linux/clock.hpp"

namespace gannet::hal {
namespace {

constexpr Duration kRetry = std::chrono::milliseconds(50);

}  // namespace

Result<std::unique_ptr<StereoCamera>> SimulatedCamera::create(const SimulatedCameraConfig& config,
                                                              Pace pace) {
  return std::unique_ptr<StereoCamera>(new SimulatedCamera(config, pace));
}

SimulatedCamera::~SimulatedCamera() {
  link_.store(kStop, std::memory_order_release);
  linux_os::futex_wake_all(link_);
  opener_.join();
}

Result<void> SimulatedCamera::start() {
  const TimePoint deadline = linux_os::monotonic_now() + from_seconds(config_.connect_timeout_s);
  for (;;) {
    auto opened = SharedFramesReader::open(config_.name);
    if (opened && !(*opened)->closed()) {
      reader_ = std::move(*opened);
      break;
    }
    const TimePoint now = linux_os::monotonic_now();
    if (now >= deadline)
      return Error{(opened ? config_.name + ": its writer has ended" : opened.error().text) +
                   "; does gannet-world run?"};
    linux_os::futex_wait(link_, kConnected, now + kRetry);
  }
  format_ = reader_->format();
  if (pace_ == Pace::kStepped) return {};
  auto thread = linux_os::Thread::start("camera-opener", {}, [this] { reopen_loop(); });
  if (!thread) return thread.error();
  opener_ = std::move(*thread);
  return {};
}

// ---- capture thread
// ------------------------------------------------------------------------------

bool SimulatedCamera::is_silent(TimePoint now) {
  if (!last_sign_) last_sign_ = now;
  return now - *last_sign_ > from_seconds(config_.silence_s);
}

// One look without waiting.
CaptureStatus SimulatedCamera::look(TimePoint now, StereoFrame& frame) {
  const std::uint64_t missed = reader_->missed();
  const CaptureStatus status = reader_->take(now, frame);
  counters_.dropped += reader_->missed() - missed;
  if (status == CaptureStatus::kFrame) {
    ++counters_.frames;
    last_sign_ = now;
    lost_ = false;
    return status;
  }
  if (status == CaptureStatus::kBroken) {
    ++counters_.broken;
    return status;
  }
  if (!is_silent(now) && !(reader_->closed() && !reader_->next_available()))
    return CaptureStatus::kNothing;
  if (!std::exchange(lost_, true)) ++counters_.lost;
  return CaptureStatus::kLost;
}

CaptureStatus SimulatedCamera::capture(TimePoint now, Duration timeout, StereoFrame& frame) {
  const TimePoint deadline = now + timeout;
  if (pace_ == Pace::kStepped) return look(now, frame);
  if (lost_) return capture_lost(now, deadline, frame);
  for (;;) {
    // The usual order against a lost wake-up: read the word, look, then sleep.
    const std::uint32_t seen = reader_->published();
    const CaptureStatus status = look(now, frame);
    if (status == CaptureStatus::kLost) return capture_lost(now, deadline, frame);
    if (status != CaptureStatus::kNothing || now >= deadline) return status;
    const auto next = reader_->next_available();
    reader_->wait(seen, next ? std::min(std::max(*next, now), deadline) : deadline);
    now = linux_os::monotonic_now();
  }
}

// Lost, live: hands the reader to the opener when all frames are home, takes the new one over when
// there is one, and sleeps out the time-out, so that a loop around us does not spin.
CaptureStatus SimulatedCamera::capture_lost(TimePoint now, TimePoint deadline, StereoFrame& frame) {
  for (;;) {
    std::uint32_t link = link_.load(std::memory_order_acquire);
    if (link == kConnected && reader_->all_home()) {
      link_.store(link = kWanted, std::memory_order_release);
      linux_os::futex_wake_all(link_);
    }
    if (link == kReady) {
      link_.store(kConnected, std::memory_order_relaxed);
      last_sign_ = now;
      lost_ = false;
      return look(now, frame);
    }
    if (now >= deadline) return CaptureStatus::kLost;
    linux_os::futex_wait(link_, link, std::min(deadline, now + kRetry));
    now = linux_os::monotonic_now();
  }
}

// ---- opener thread
// -------------------------------------------------------------------------------

void SimulatedCamera::reopen_loop() {
  for (;;) {
    std::uint32_t link = link_.load(std::memory_order_acquire);
    if (link == kStop) return;
    if (link != kWanted) {
      linux_os::futex_wait(link_, link, linux_os::monotonic_now() + std::chrono::hours(1));
      continue;
    }
    reader_.reset();
    reader_ = reopen();
    // Fails only when we are to stop.
    link = kWanted;
    link_.compare_exchange_strong(link, kReady, std::memory_order_acq_rel);
    linux_os::futex_wake_all(link_);
  }
}

// A world that publishes: one that died without a word leaves its file, which stays silent.
std::unique_ptr<SharedFramesReader> SimulatedCamera::reopen() {
  bool told = false;
  while (link_.load(std::memory_order_acquire) == kWanted) {
    auto opened = SharedFramesReader::open(config_.name);
    const std::uint32_t published = opened ? (*opened)->published() : 0;
    linux_os::futex_wait(link_, kWanted, linux_os::monotonic_now() + kRetry);
    if (!opened || (*opened)->closed()) continue;
    const bool fits = (*opened)->format() == format_;
    if (!fits && !std::exchange(told, true))
      log(Severity::kWarning, "camera '" + config_.name + "' has come back with another size or " +
                                  "pixel format; restart gannetd to use it");
    if (fits && (*opened)->published() != published) return std::move(*opened);
  }
  return nullptr;
}

}  // namespace gannet::hal
