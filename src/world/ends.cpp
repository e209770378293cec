#include "src/world/ends.hpp"

#include <string_view>

#include "src/world/shared_frame_sink.hpp"
#include "src/world/v4l2_frame_sink.hpp"

namespace gannet::world {
namespace {

// What stands behind "kind:"; an Error for anything else.
Result<std::string> place_of(const std::string& option, const std::string& text,
                             const std::string& kind, const std::string& form) {
  if (text.empty()) return std::string();
  if (text.starts_with(kind + ":") && text.size() > kind.size() + 1)
    return text.substr(kind.size() + 1);
  return Error{"--" + option + " '" + text + "': the form is " + kind + ":" + form};
}

}  // namespace

Result<EndsConfig> parse_ends(const std::string& cameras, const std::string& can,
                              const std::string& lines) {
  EndsConfig ends;
  const auto video = place_of("cameras", cameras, "v4l2", "/dev/video10,/dev/video11");
  if (!video) return video.error();
  if (!video->empty()) {
    const std::size_t comma = video->find(',');
    if (comma == std::string::npos || comma == 0 || comma + 1 == video->size())
      return Error{"--cameras '" + cameras + "': the form is v4l2:LEFT,RIGHT"};
    ends.video = {video->substr(0, comma), video->substr(comma + 1)};
  }
  const auto interface = place_of("can", can, "socketcan", "vcan0");
  if (!interface) return interface.error();
  ends.can_interface = *interface;
  const auto folder = place_of("lines", lines, "gpio-sim", "DIR");
  if (!folder) return folder.error();
  ends.gpio_folder = *folder;
  return ends;
}

Result<std::unique_ptr<FrameSink>> make_frame_sink(const EndsConfig& ends, const Scenario& scenario,
                                                   const RunFiles& files) {
  const CameraConfig& camera = scenario.camera;
  if (ends.video[0].empty())
    return SharedFrameSink::create(files.frames(), camera.width, camera.height);
  return V4l2FrameSink::create({.devices = ends.video,
                                .width = camera.width,
                                .height = camera.height,
                                .rate_hz = camera.fps});
}

CanEndConfig can_end_of(const EndsConfig& ends, const RunFiles& files) {
  if (ends.can_interface.empty()) return {"local", files.bus()};
  return {"socketcan", ends.can_interface};
}

LineEndConfig line_end_of(const EndsConfig& ends, const Scenario& scenario, const RunFiles& files) {
  const bool two = scenario.vehicle.estop_contacts == 2;
  if (ends.gpio_folder.empty()) return {"simulated", files.lines(), two};
  return {"gpio-sim", ends.gpio_folder, two};
}

void configure_ends(const EndsConfig& ends, const Scenario& scenario,
                    config::DaemonConfig& config) {
  if (!ends.video[0].empty()) {
    config.camera.kind = "v4l2_pair";
    hal::V4l2PairConfig& pair = config.camera.v4l2_pair;
    pair.left = ends.video[kLeftSide];
    pair.right = ends.video[kRightSide];
    pair.stream.width = scenario.camera.width;
    pair.stream.height = scenario.camera.height;
    pair.stream.rate_hz = scenario.camera.fps;
    pair.stream.format = "yuyv";
    pair.stream.accept_unknown_clock = true;  // v4l2loopback passes our stamps on, unnamed
  }
  if (!ends.can_interface.empty()) {
    config.can.kind = "socketcan";
    config.can.interface = ends.can_interface;
  }
}

}  // namespace gannet::world
