// The one table of camera kinds. A new kind: its file pair, a line in camera_kinds.cpp, its config
// in camera_config.hpp. Start-up only.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hal/camera/camera_config.hpp"
#include "hal/camera/image_decoder.hpp"
#include "hal/camera/stereo_camera.hpp"

namespace gannet::hal {

std::vector<std::string> camera_kinds();

// The camera that the config asks for, not yet started. Error: an unknown kind (with the known
// ones), or what that kind lacks: a folder, an image's twin, ….
Result<std::unique_ptr<StereoCamera>> make_stereo_camera(const CameraConfig& config,
                                                         DecodeImage decode, Pace pace);

}  // namespace gannet::hal
