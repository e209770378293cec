// SkeletonCamera: the least that a camera kind needs, to be copied. It gives grey pairs at a fixed
// rate; replace what is marked by numbers with your device. Then:
//   - one struct with describe() in camera_config.hpp,
//   - one line in camera_kinds.cpp,
//   - a test beside tests/unit/hal/camera/skeleton_camera_test.cpp.
// Not in the table of kinds itself: nobody wants grey pairs.
// create() and start() are start-up only, capture() belongs to the capture thread and is RT safe.
#pragma once

#include <memory>
#include <vector>

#include "hal/camera/image.hpp"
#include "hal/camera/stereo_camera.hpp"

namespace gannet::hal {

// 1. What the config says of the device.
struct SkeletonCameraConfig {
  int width = 64;  // pixels
  int height = 48;
  double rate_hz = 30;
  int slots = 4;  // pairs out at once, at least: in the ring, in vision, in the archive
};

class SkeletonCamera final : public StereoCamera {
 public:
  // 2. Refuse here what can be known to be wrong, in words that say what to do.
  static Result<std::unique_ptr<StereoCamera>> create(const SkeletonCameraConfig& config,
                                                      Pace pace);

  int width() const override { return config_.width; }
  int height() const override { return config_.height; }
  Result<void> start() override;
  CaptureStatus capture(TimePoint now, Duration timeout, StereoFrame& frame) override;
  CaptureCounters counters() const override { return counters_; }

 private:
  struct Pair {
    Image left, right;
  };
  SkeletonCamera(const SkeletonCameraConfig& config, Pace pace);

  const SkeletonCameraConfig config_;
  const Pace pace_;
  std::vector<Pair> pairs_;  // 3. All memory is taken at creation, one element a slot …
  LeasePool pool_;           // … and the pool says which of them are home.
  TimePoint due_ = {};       // of the next pair; the epoch: at the first capture
  std::uint64_t number_ = 0;
  CaptureCounters counters_;
};

}  // namespace gannet::hal
