// ControlCommands: what the daemon answers to each method of the control socket. Everything is
// checked here, before it goes to a loop. Methods and their params: docs/reference/control.md.
// Control thread.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "src/config/daemon_config.hpp"
#include "src/control/protocol.hpp"
#include "src/control/server.hpp"
#include "src/daemon/mission_pilot.hpp"
#include "src/daemon/reports.hpp"
#include "src/servo/servo_config.hpp"
#include "src/vision/patch_model.hpp"

namespace gannet::daemon {

// What commands are written into.
struct CommandLines {
  SpscRing<TargetChoice> to_vision{16};
  SpscRing<ServoCommand> to_servo{16};
  LatestValue<servo::ServoParams> params;
};

class ControlCommands {
 public:
  struct Setting {
    const config::LoadedConfig* loaded;
    std::vector<std::string> models;                // names, by index
    std::vector<vision::Symmetry> symmetries = {};  // of the models
    int image_width = 0;                            // pixels
    int image_height = 0;
    const control::ServerCounters* server = nullptr;  // may be null
    std::function<TimePoint()> now;
    // Lets the loops run a little while; empty in stepped time, where they run at the next step
    // and a request is answered before it is served.
    std::function<void()> pause;
  };

  ControlCommands(Setting setting, Reports* reports, CommandLines* lines);

  control::Answer handle(const control::Request& request);

  // Steps the mission; as often as the control thread turns.
  void advance();

  // The methods' names, for help and tests.
  static std::vector<std::string> methods();

 private:
  using Method = control::Answer (ControlCommands::*)(const control::Json& params);
  struct Entry {
    const char* name;
    Method method;
    std::vector<std::string_view> params;  // that it knows
  };
  static const std::vector<Entry>& table();

  control::Answer status(const control::Json&);
  control::Answer top(const control::Json&);
  control::Answer events(const control::Json& params);
  control::Answer config_show(const control::Json&);
  control::Answer arm(const control::Json&);
  control::Answer disarm(const control::Json&);
  control::Answer reset(const control::Json&);
  control::Answer stop(const control::Json&);
  control::Answer target(const control::Json& params);
  control::Answer goal(const control::Json& params);
  control::Answer mission(const control::Json& params);
  control::Answer manual(const control::Json& params);

  control::Answer request(safety::Request request, const char* name);
  // False: too many choices wait.
  bool choose(TargetChoice choice);
  void set_goal(const Eigen::Vector3d& goal_m);
  control::Answer start_mission();
  control::Answer stop_mission();
  void obey(const MissionPilot::Turn& turn);
  bool push(ServoCommand command);
  bool wait_until_served();
  control::Json state_json() const;
  control::Json drives_json() const;

  Setting setting_;
  Reports* reports_;
  CommandLines* lines_;
  servo::ServoParams params_;
  TargetChoice target_;
  MissionPilot mission_;
  bool owes_none_ = false;  // the mission wants no target, but the vision loop had no room
  std::uint32_t target_count_ = 0;
  std::uint64_t command_count_ = 0;
};

}  // namespace gannet::daemon
