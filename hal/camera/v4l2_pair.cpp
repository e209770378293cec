#include "hal/camera/v4l2_pair.hpp"

#include <algorithm>
#include <utility>

#include "hal/camera/v4l2_camera.hpp"

namespace gannet::hal {

V4l2Image PairByTime::Queue::pop() {
  V4l2Image first = std::move(images[0]);
  std::move(images.begin() + 1, images.begin() + static_cast<std::ptrdiff_t>(count),
            images.begin());
  --count;
  return first;
}

void PairByTime::drop_oldest(Queue& queue) {
  queue.pop();
  ++unpaired_;
}

void PairByTime::measure(Duration skew) {
  if (std::chrono::abs(skew) > period_ / 2) return;  // of neighbours, not of twins
  skew_ = skew;
  largest_skew_ = std::max(largest_skew_, Duration(std::chrono::abs(skew)));
}

void PairByTime::put(Side side, V4l2Image&& image) {
  Queue& queue = queues_[side];
  if (queue.count == kMostWaiting) drop_oldest(queue);
  queue.images[queue.count++] = std::move(image);
}

bool PairByTime::take(V4l2Image& left, V4l2Image& right) {
  auto& [lefts, rights] = queues_;
  while (lefts.count > 0 && rights.count > 0) {
    const Duration skew = rights.images[0].stamp - lefts.images[0].stamp;
    measure(skew);
    if (std::chrono::abs(skew) <= tolerance_) {
      left = lefts.pop();
      right = rights.pop();
      return true;
    }
    // Whatever comes is newer still: the older one's twin has been missed.
    drop_oldest(skew > Duration{} ? lefts : rights);
  }
  return false;
}

void PairByTime::clear(Side side) {
  while (queues_[side].count > 0) drop_oldest(queues_[side]);
}

Result<std::unique_ptr<StereoCamera>> make_v4l2_pair(const V4l2PairConfig& config,
                                                     DecodeImage decode, Pace pace,
                                                     V4l2System& system) {
  const V4l2StreamConfig& stream = config.stream;
  if (config.left.empty() || config.right.empty())
    return Error{"camera.v4l2_pair: left and right must name devices; `gannet cameras` lists them"};
  if (config.left == config.right)
    return Error{"camera.v4l2_pair: left and right are the same device, " + config.left};
  if (stream.rate_hz > 0 && config.pair_tolerance_s >= 0.5 / stream.rate_hz)
    return Error{"camera.v4l2_pair.pair_tolerance_s: must be less than half a period, " +
                 std::to_string(0.5 / stream.rate_hz) + " s"};
  if (pace == Pace::kStepped) return Error{"camera.kind: V4L2 devices follow the live clock alone"};
  return V4l2Camera::create({.paths = {config.left, config.right},
                             .stream = stream,
                             .tolerance = from_seconds(config.pair_tolerance_s),
                             .right_first = false},
                            decode, system);
}

}  // namespace gannet::hal
