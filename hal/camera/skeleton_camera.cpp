#include "hal/camera/skeleton_camera.hpp"

#include <algorithm>

#include "platform/linux/clock.hpp"
#include "platform/linux/futex.hpp"

namespace gannet::hal {

Result<std::unique_ptr<StereoCamera>> SkeletonCamera::create(const SkeletonCameraConfig& config,
                                                             Pace pace) {
  if (layout_of(PixelFormat::kYuv420, config.width, config.height).bytes == 0)
    return Error{"camera.skeleton: width and height must be even, 2 to 16384"};
  return std::unique_ptr<StereoCamera>(new SkeletonCamera(config, pace));
}

SkeletonCamera::SkeletonCamera(const SkeletonCameraConfig& config, Pace pace)
    : config_(config), pace_(pace), pool_(config.slots) {
  const Image blank(config.width, config.height, PixelFormat::kYuv420);
  pairs_.assign(static_cast<std::size_t>(config.slots), {blank, blank});
}

// 4. Open and start the device. Threads that decode or reopen are started here too.
Result<void> SkeletonCamera::start() { return {}; }

// 5. From here on no heap, no lock, no text: this is the capture thread.
CaptureStatus SkeletonCamera::capture(TimePoint now, Duration timeout, StereoFrame& frame) {
  if (due_ == TimePoint{}) due_ = now;
  const TimePoint deadline = now + timeout;
  // 6. Wait for the device, at most until the deadline, and never on the stepped clock.
  while (pace_ == Pace::kLive && now < std::min(due_, deadline)) {
    const linux_os::FutexWord nobody_wakes_us{0};  // a device would be waited for by poll()
    linux_os::futex_wait(nobody_wakes_us, 0, std::min(due_, deadline));
    now = linux_os::monotonic_now();
  }
  if (now < due_) return CaptureStatus::kNothing;
  // 7. A pair is there: it has a time (the middle of its exposure) and a number, used or not.
  const TimePoint capture_time = due_;
  due_ += from_seconds(1 / config_.rate_hz);
  ++number_;
  // 8. Check it: short, stale or backward in time is kBroken. Ours are always good.
  Lease lease = pool_.lend();
  if (!lease.valid()) {
    ++counters_.dropped;
    return CaptureStatus::kNoSlot;
  }
  // 9. Bring the pixels into the slot (or lend the driver's own buffer: LeasePool::lend_slot).
  Pair& pair = pairs_[static_cast<std::size_t>(lease.slot())];
  std::ranges::fill(pair.left.bytes(), std::uint8_t{128});
  std::ranges::fill(pair.right.bytes(), std::uint8_t{128});
  // 10. Hand it over. The lease brings the slot home when its last holder drops it.
  frame.left = pair.left.view();
  frame.right = pair.right.view();
  frame.left_lease = std::move(lease);
  frame.right_lease = Lease{};
  frame.capture_time = capture_time;
  frame.number = number_;
  ++counters_.frames;
  return CaptureStatus::kFrame;
}

}  // namespace gannet::hal
