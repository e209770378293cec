#include "hal/camera/v4l2_side_by_side.hpp"

#include "hal/camera/v4l2_camera.hpp"

namespace gannet::hal {

Result<std::unique_ptr<StereoCamera>> make_v4l2_side_by_side(const V4l2SideBySideConfig& config,
                                                             DecodeImage decode, Pace pace,
                                                             V4l2System& system) {
  if (config.device.empty())
    return Error{"camera.v4l2_side_by_side: device must be named; `gannet cameras` lists them"};
  // Chroma goes by pairs of pixels, and a pair must not lie in both halves.
  if (config.stream.width % 4 != 0)
    return Error{"camera.v4l2_side_by_side.width: must be a multiple of 4"};
  if (pace == Pace::kStepped) return Error{"camera.kind: V4L2 devices follow the live clock alone"};
  return V4l2Camera::create({.paths = {config.device},
                             .stream = config.stream,
                             .tolerance = {},
                             .right_first = config.right_first},
                            decode, system);
}

}  // namespace gannet::hal
