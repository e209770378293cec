// All of gannetd's parameters: every room's struct by its group, and how files, boards and --set
// become one. Start-up only; the daemon owns the value.
#pragma once

#include <string>
#include <vector>

#include "hal/camera/camera_config.hpp"
#include "hal/can/can_config.hpp"
#include "hal/drive/drive_config.hpp"
#include "hal/gpio/line_config.hpp"
#include "platform/base/describe.hpp"
#include "platform/base/result.hpp"
#include "platform/linux/thread.hpp"
#include "src/config/loader.hpp"
#include "src/core/stereo_rig.hpp"
#include "src/safety/safety_config.hpp"
#include "src/servo/mission_config.hpp"
#include "src/servo/servo_config.hpp"
#include "src/track/filter_config.hpp"
#include "src/track/track_config.hpp"
#include "src/vehicle/vehicle_config.hpp"

namespace gannet::config {

// Facts of the computer. name chooses a board file, which states the others.
struct BoardConfig {
  std::string name;
  int cores = 0;  // 0: not known
  std::vector<std::string> cameras;
  std::vector<std::string> can_interfaces;
  std::vector<std::string> gpio_chips;
};

struct RealtimeConfig {
  double servo_rate_hz = 200;
  bool lock_memory = true;
  linux_os::ThreadConfig capture = {-1, 70};
  linux_os::ThreadConfig vision = {-1, 50};
  linux_os::ThreadConfig servo = {-1, 80};
  std::vector<int> worker_cores;  // a helper of the vision thread on each; −1: any
  int worker_priority = 50;
};

struct ClockConfig {
  std::string kind = "live";
  std::string step_socket;  // of a stepped clock
};

inline hal::LineConfig pulled_up_line() {
  hal::LineConfig line;
  line.bias = "pull_up";  // a broken wire shall be a stop
  return line;
}

// Digital lines; kind "none" is one that is not fitted.
struct GpioConfig {
  hal::LineConfig estop = pulled_up_line();         // input, active: pressed
  hal::LineConfig estop_second = pulled_up_line();  // input, the button's other contact
  hal::LineConfig release;                          // output of the spear or gripper
  hal::LineConfig light;   // output: off, slow, on, fast tell the supervisor's state
  hal::LineConfig lights;  // output, active while the daemon runs
  hal::LineConfig strobe;  // output, active while the daemon runs
};

// What the archive loop does with frames.
struct FramesConfig {
  std::string kind = "none";
  std::string directory;
};

struct ControlConfig {
  std::string socket = "/run/gannet/control";
  std::string group;  // whose members may connect; "": the daemon's own user only
};

struct DaemonConfig {
  std::string rig;                  // path
  std::vector<std::string> models;  // paths of .gannet files
  BoardConfig board;
  RealtimeConfig realtime;
  ClockConfig clock;
  hal::CameraConfig camera;
  hal::CanConfig can;
  hal::DriveConfig drive;
  GpioConfig gpio;
  track::TrackConfig track;
  track::FilterConfig filter;
  servo::ServoConfig servo;
  servo::MissionConfig mission;
  vehicle::VehicleConfig vehicle;
  safety::SafetyConfig safety;
  FramesConfig frames;
  ControlConfig control;
};

void describe(Visitor& v, DaemonConfig& c);

struct ConfigSources {
  std::string file;                      // gannet.toml; beside it gannet.toml.d/*.toml; "": none
  std::vector<std::string> sets;         // "room.key=value", the last word
  std::vector<std::string> boards = {};  // folders of board files; empty: board_folders()
};

struct LoadedConfig {
  DaemonConfig config;
  Origins origins;
  std::vector<std::string> files;  // that were read, in order
  StereoRig rig;

  std::string show() const;  // each value with its origin, a line each
};

// Precedence: built-in < board file < file < gannet.toml.d/*.toml by name < sets. Paths in a file
// are relative to it, paths in sets to the current folder. Loads the rig and checks that the
// groups fit each other. Errors: all problems, each with its place.
Result<LoadedConfig> load_daemon_config(const ConfigSources& sources);

// The built-in values as a commented file.
std::string print_default();

// Where board files are: beside the running program when installed, or in the source tree.
std::vector<std::string> board_folders();

std::string config_markdown();  // docs/reference/gannet.toml.md
std::string config_man_page();  // gannet.toml(5)

}  // namespace gannet::config
