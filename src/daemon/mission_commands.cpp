// What ControlCommands answers about the mission, and how it obeys it: by choosing targets and
// goals as a person would.
#include "src/daemon/control_commands.hpp"
#include "src/telemetry/event_codes.hpp"

namespace gannet::daemon {

using control::Answer;
using control::ErrorCode;
using control::Failure;
using control::Json;
using servo::MissionState;
using telemetry::make_event;

void ControlCommands::advance() {
  if (owes_none_) choose({});
  if (!mission_.under_way()) return;
  reports_->refresh();
  obey(mission_.step(reports_->vision(), reports_->servo(), target_.id, setting_.now()));
}

Answer ControlCommands::mission(const Json& params) {
  const bool has_word = params.contains("do") && params["do"].is_string();
  const std::string word = has_word ? params["do"].get<std::string>() : "";
  if (word == "list") return mission_.list_json();
  if (word == "status") return mission_.status_json();
  if (word == "start") return start_mission();
  if (word == "stop") return stop_mission();
  return Failure{ErrorCode::kBadParams,
                 "mission takes \"do\": \"list\", \"start\", \"stop\" or \"status\""};
}

Answer ControlCommands::start_mission() {
  const auto refuse = [](const char* reason, const char* text) {
    return Failure{ErrorCode::kRefused, std::string("mission start is refused: ") + text, reason};
  };
  if (mission_.visits() == 0) return refuse("no_mission", "the config has no [[mission.visit]]");
  const MissionState state = mission_.memory().state;
  if (state == MissionState::kRunning || state == MissionState::kPaused)
    return refuse("under_way", "it is under way; mission stop ends it");
  const TimePoint now = setting_.now();
  if (!is_armed(reports_->servo(), now))
    return refuse("not_armed", "the vehicle is not armed, which only a person does");
  obey(mission_.start(reports_->servo(), now));
  return mission_.status_json();
}

Answer ControlCommands::stop_mission() {
  obey(mission_.stop(false));
  return mission_.status_json();
}

// Goal before target: a new target is never steered to the old goal. A vision loop that has no room
// for the choice stands still: the mission ends, and no target is chosen as soon as there is room.
void ControlCommands::obey(const MissionPilot::Turn& turn) {
  TargetChoice choice;
  if (turn.begins) {
    set_goal(turn.goal_m);
    choice.kind = TargetChoice::Kind::kModel;
    choice.model = turn.model;
  }
  if ((turn.begins || turn.drops) && !choose(choice)) {
    owes_none_ = true;
    if (turn.begins) return obey(mission_.stop(false));
  }
  if (!turn.changed) return;
  const servo::MissionMemory& memory = mission_.memory();
  const TimePoint now = setting_.now();
  reports_->add_event(
      memory.state == MissionState::kTimedOut
          ? make_event(telemetry::kMissionTimedOut, now, memory.visit + 1, mission_.visits())
          : make_event(telemetry::kMissionChanged, now, static_cast<double>(memory.state),
                       memory.visit + 1, mission_.visits()));
}

}  // namespace gannet::daemon
