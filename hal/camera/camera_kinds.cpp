#include "hal/camera/camera_kinds.hpp"

#include "hal/camera/replay_camera.hpp"
#include "hal/camera/simulated_camera.hpp"
#include "hal/camera/v4l2_pair.hpp"
#include "hal/camera/v4l2_side_by_side.hpp"

namespace gannet::hal {
namespace {

using Made = Result<std::unique_ptr<StereoCamera>>;

struct Kind {
  const char* name;
  Made (*make)(const CameraConfig& config, DecodeImage decode, Pace pace);
};

constexpr Kind kKinds[] = {
    {"replay", [](const CameraConfig& config, DecodeImage decode,
                  Pace pace) { return ReplayCamera::create(config.replay, decode, pace); }},
    {"simulated", [](const CameraConfig& config, DecodeImage,
                     Pace pace) { return SimulatedCamera::create(config.simulated, pace); }},
    {"v4l2_pair", [](const CameraConfig& config, DecodeImage decode,
                     Pace pace) { return make_v4l2_pair(config.v4l2_pair, decode, pace); }},
    {"v4l2_side_by_side",
     [](const CameraConfig& config, DecodeImage decode, Pace pace) {
       return make_v4l2_side_by_side(config.v4l2_side_by_side, decode, pace);
     }},
};

}  // namespace

std::vector<std::string> camera_kinds() {
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) names.push_back(kind.name);
  return names;
}

Result<std::unique_ptr<StereoCamera>> make_stereo_camera(const CameraConfig& config,
                                                         DecodeImage decode, Pace pace) {
  std::string known;
  for (const Kind& kind : kKinds) {
    if (config.kind == kind.name) return kind.make(config, decode, pace);
    known += (known.empty() ? "" : ", ") + std::string(kind.name);
  }
  return Error{"camera.kind: '" + config.kind + "' is not known; known are " + known};
}

}  // namespace gannet::hal
