// One V4L2 device whose image holds both cameras' images side by side, exposed together: each half
// is seen where it lies, nothing is copied. Start-up only.
#pragma once

#include <memory>

#include "hal/camera/camera_config.hpp"
#include "hal/camera/image_decoder.hpp"
#include "hal/camera/stereo_camera.hpp"
#include "hal/camera/v4l2_system.hpp"

namespace gannet::hal {

// Error: no device named, a width that does not halve, no live clock.
Result<std::unique_ptr<StereoCamera>> make_v4l2_side_by_side(const V4l2SideBySideConfig& config,
                                                             DecodeImage decode, Pace pace,
                                                             V4l2System& system = kernel_v4l2());

}  // namespace gannet::hal
