// Two V4L2 devices as one stereo camera: PairByTime finds the images that belong together.
// PairByTime: capture thread, RT safe. make_v4l2_pair: start-up only.
#pragma once

#include <array>
#include <memory>

#include "hal/camera/camera_config.hpp"
#include "hal/camera/image_decoder.hpp"
#include "hal/camera/stereo_camera.hpp"
#include "hal/camera/v4l2_device.hpp"

namespace gannet::hal {

// Pairs images whose stamps are at most the tolerance apart. Images of each side come in the order
// of their stamps; one that has missed its twin, or waits while three newer ones come, goes home.
class PairByTime {
 public:
  enum Side { kLeft, kRight };
  // period: between two images of a side; the tolerance is less than half of it, so that an image
  // has one twin at most.
  PairByTime(Duration tolerance, Duration period) : tolerance_(tolerance), period_(period) {}

  void put(Side side, V4l2Image&& image);
  bool take(V4l2Image& left, V4l2Image& right);  // the oldest pair; false: none
  void clear(Side side);                         // its device is gone

  std::uint64_t unpaired() const { return unpaired_; }  // images so far
  // Right stamp − left stamp of the newest two that may belong together, paired or not, and the
  // largest so far: who sees unpaired images grow learns here which tolerance they would need.
  Duration skew() const { return skew_; }
  Duration largest_skew() const { return largest_skew_; }

 private:
  static constexpr std::size_t kMostWaiting = 3;
  struct Queue {
    std::array<V4l2Image, kMostWaiting> images;  // oldest first
    std::size_t count = 0;
    V4l2Image pop();
  };
  void drop_oldest(Queue& queue);
  void measure(Duration skew);

  const Duration tolerance_;
  const Duration period_;
  std::array<Queue, 2> queues_;
  std::uint64_t unpaired_ = 0;
  Duration skew_ = {};
  Duration largest_skew_ = {};
};

// Error: no device named, the same one twice, a tolerance of half a period or more, no live clock.
Result<std::unique_ptr<StereoCamera>> make_v4l2_pair(const V4l2PairConfig& config,
                                                     DecodeImage decode, Pace pace,
                                                     V4l2System& system = kernel_v4l2());

}  // namespace gannet::hal
