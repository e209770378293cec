#include "hal/camera/v4l2_link.hpp"

#include <algorithm>
#include <utility>

#include "hal/camera/v4l2_controls.hpp"
#include "platform/base/log.hpp"
#include "platform/linux/clock.hpp"

namespace gannet::hal {
namespace {

constexpr Duration kFirstPause = std::chrono::milliseconds(20);
constexpr Duration kLongestPause = std::chrono::seconds(1);
// A USB camera's first image takes a second and more.
constexpr Duration kFirstImage = std::chrono::seconds(2);

}  // namespace

V4l2Link::~V4l2Link() {
  state_.store(kStop, std::memory_order_release);
  linux_os::futex_wake_all(state_);
  opener_.join();
}

Result<void> V4l2Link::start() {
  const TimePoint deadline = linux_os::monotonic_now() + from_seconds(config_.connect_timeout_s);
  Duration wait = kFirstPause;
  for (;;) {
    bool may_pass = false;
    auto opened = V4l2Device::open(system_, path_, config_, may_pass);
    if (opened) {
      device_ = std::move(*opened);
      break;
    }
    if (!may_pass || linux_os::monotonic_now() >= deadline) return opened.error();
    pause(std::exchange(wait, std::min(2 * wait, kLongestPause)));
  }
  format_ = device_->format();
  introduce(*device_);
  auto thread = linux_os::Thread::start("camera-opener", {}, [this] { reopen_loop(); });
  if (!thread) return thread.error();
  opener_ = std::move(*thread);
  return {};
}

// What a person should know of it without asking.
void V4l2Link::introduce(const V4l2Device& device) const {
  if (!device.names_its_clock())
    log(Severity::kWarning, path_ +
                                ": its driver does not say of which clock its time stamps are; "
                                "they are taken for CLOCK_MONOTONIC's");
  if (device.buffers() < config_.buffers)
    log(Severity::kNotice, path_ + ": has " + std::to_string(device.buffers()) + " buffers where " +
                               std::to_string(config_.buffers) + " were asked for");
  if (moves_the_hue(list_controls(system_, device.fd())))
    log(Severity::kWarning, path_ +
                                ": its automatic white balance is on, which moves the hue; "
                                "switch it off by `controls`");
}

void V4l2Link::pause(Duration length) const {
  linux_os::futex_wait(state_, state_.load(std::memory_order_relaxed),
                       linux_os::monotonic_now() + length);
}

// ---- capture thread
// ------------------------------------------------------------------------------

V4l2Taken V4l2Link::take(TimePoint now, CaptureCounters& counters, V4l2Image& image) {
  if (lost_ && !is_back(now)) return V4l2Taken::kGone;
  if (!last_good_) last_good_ = now + kFirstImage;
  V4l2Taken taken = device_->take(now, counters, image);
  if (taken == V4l2Taken::kImage || taken == V4l2Taken::kNoSlot) last_good_ = now;
  const bool is_silent = now - *last_good_ > from_seconds(config_.silence_s);
  if ((taken == V4l2Taken::kNothing && has_error_) || is_silent) taken = V4l2Taken::kGone;
  has_error_ = false;
  if (taken != V4l2Taken::kGone) return taken;
  lost_ = true;
  ++counters.lost;
  return taken;
}

// Hands the lost device to the opener once all its images are home, and takes the new one over.
bool V4l2Link::is_back(TimePoint now) {
  const std::uint32_t state = state_.load(std::memory_order_acquire);
  if (state == kConnected && device_->all_home()) {
    state_.store(kWanted, std::memory_order_release);
    linux_os::futex_wake_all(state_);
  }
  if (state != kReady) return false;
  state_.store(kConnected, std::memory_order_relaxed);
  lost_ = false;
  last_good_ = now + kFirstImage;
  return true;
}

// ---- opener thread
// -------------------------------------------------------------------------------

void V4l2Link::reopen_loop() {
  for (;;) {
    const std::uint32_t state = state_.load(std::memory_order_acquire);
    if (state == kStop) return;
    if (state != kWanted) {
      linux_os::futex_wait(state_, state, linux_os::monotonic_now() + std::chrono::hours(1));
      continue;
    }
    device_.reset();
    device_ = reopen();
    // Fails only when we are to stop.
    std::uint32_t wanted = kWanted;
    state_.compare_exchange_strong(wanted, kReady, std::memory_order_acq_rel);
  }
}

V4l2Link::Device V4l2Link::reopen() {
  std::string told;
  for (Duration wait = kFirstPause; state_.load(std::memory_order_acquire) == kWanted;
       wait = std::min(2 * wait, kLongestPause)) {
    linux_os::futex_wait(state_, kWanted, linux_os::monotonic_now() + wait);
    bool may_pass = false;
    auto opened = V4l2Device::open(system_, path_, config_, may_pass);
    if (opened && (*opened)->format() == format_) return std::move(*opened);
    const std::string problem =
        opened
            ? path_ + ": came back with another layout or colour space; restart gannetd to use it"
            : opened.error().text;
    // Each reason once, not at each attempt.
    if (problem != told) log(Severity::kWarning, "camera: " + problem);
    told = problem;
  }
  return nullptr;
}

}  // namespace gannet::hal
