// Ends: where a world meets its daemon: in files and sockets of the run's own, or at the kernel's
// interfaces, each chosen by an option. Start-up only.
#pragma once

#include <array>
#include <string>

#include "platform/base/result.hpp"
#include "src/world/can_end.hpp"
#include "src/world/frame_sink.hpp"
#include "src/world/line_end.hpp"
#include "src/world/run_files.hpp"
#include "src/world/scenario.hpp"

namespace gannet::world {

struct EndsConfig {
  std::array<std::string, 2> video = {};  // V4L2 output devices by Side; empty: shared memory
  std::string can_interface = "";         // empty: a local bus
  std::string gpio_folder = "";           // of gpio-sim; empty: simulated lines

  bool any_real() const {
    return !video[0].empty() || !can_interface.empty() || !gpio_folder.empty();
  }
};

// From "v4l2:/dev/video10,/dev/video11", "socketcan:vcan0", "gpio-sim:DIR"; "" is the run's own.
// Error: not of that form.
Result<EndsConfig> parse_ends(const std::string& cameras, const std::string& can,
                              const std::string& lines);

Result<std::unique_ptr<FrameSink>> make_frame_sink(const EndsConfig& ends, const Scenario& scenario,
                                                   const RunFiles& files);
CanEndConfig can_end_of(const EndsConfig& ends, const RunFiles& files);
LineEndConfig line_end_of(const EndsConfig& ends, const Scenario& scenario, const RunFiles& files);

// What the daemon is told of cameras and bus (of lines: configure_lines).
void configure_ends(const EndsConfig& ends, const Scenario& scenario, config::DaemonConfig& config);

}  // namespace gannet::world
