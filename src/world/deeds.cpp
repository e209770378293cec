#include "src/world/deeds.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <string>

namespace gannet::world {
namespace {

Eigen::Vector3d metres(const Action& action) {
  return Eigen::Vector3d(action.numbers[0], action.numbers[1], action.numbers[2]) / 1000;
}

void press(Button button, TimePoint now, Parts& parts) {
  parts.intent.estop = button != Button::kReleased;
  parts.lines.press(button, now);
}

// False: no action of cameras.
bool act_on_cameras(const Action& action, TimePoint now, Cameras& cameras) {
  CameraFaults& faults = cameras.faults();
  const auto delay = [&] { return from_seconds(action.numbers[0] / 1000); };
  switch (action.verb) {
    case Verb::kBlind:
      return cameras.set_blind(true), true;
    case Verb::kSee:
      cameras.set_drop_share(0);
      return cameras.set_blind(false), true;
    case Verb::kDrop:
      return cameras.set_drop_share(action.numbers[0]), true;
    case Verb::kFreezeCamera:
      return faults.frozen = true, true;
    case Verb::kBackwardStamps:
      return faults.backward_since = now, true;
    case Verb::kShortFrames:
      return faults.is_short = true, true;
    case Verb::kLateLeft:
      return faults.late[kLeftSide] = delay(), true;
    case Verb::kLateRight:
      return faults.late[kRightSide] = delay(), true;
    case Verb::kSkewLeft:
      return faults.skew[kLeftSide] = delay(), true;
    case Verb::kSkewRight:
      return faults.skew[kRightSide] = delay(), true;
    case Verb::kMendCamera:
      return faults = {}, true;
    default:
      return false;
  }
}

// False: no action of drives.
bool act_on_drive(const Action& action, int drive, Parts& parts) {
  MotorFaults& node = parts.motors->faults(drive);
  switch (action.verb) {
    case Verb::kSilenceDrive:
      return node.silent = true;
    case Verb::kFaultDrive:
      return node.faulty = true;
    case Verb::kJamDrive:
      return parts.plant.jam(drive, true), true;
    case Verb::kLateDrive:
      return node.late = from_seconds(action.numbers[1] / 1000), true;
    case Verb::kGarbageDrive:
      return node.garbage = action.numbers[1], true;
    case Verb::kMendDrive:
      node = {};
      return parts.plant.jam(drive, false), true;
    default:
      return false;
  }
}

bool is_of_drives(Verb verb) {
  return (verb >= Verb::kSilenceDrive && verb <= Verb::kMendDrive) || verb == Verb::kLateDrive ||
         verb == Verb::kGarbageDrive;
}

Result<void> act_on_bus(const Action& action, TimePoint now, CanEnd& bus) {
  switch (action.verb) {
    case Verb::kBusOff:
      bus.bus_off(now);
      return {};
    case Verb::kBusPassive:
      bus.bus_passive(now);
      return {};
    case Verb::kBusDown:
      return bus.bus_down();
    case Verb::kBusUp:
      return bus.bus_up(now);
    default:
      return {};
  }
}

void act_on_water(const Action& action, TimePoint now, Parts& parts) {
  Stage& stage = parts.stage;
  switch (action.verb) {
    case Verb::kPressEstop:
      return press(Button::kPressed, now, parts);
    case Verb::kReleaseEstop:
      return press(Button::kReleased, now, parts);
    case Verb::kCutEstop:
      return press(Button::kCut, now, parts);
    case Verb::kTarget:
      if (action.name != "none") parts.intent.target = stage.find(action.name);
      return;
    case Verb::kGoal:
      parts.intent.goal_m = metres(action);
      return;
    case Verb::kOcclude:
      return stage.cover(stage.find(action.name), true);
    case Verb::kUncover:
      return stage.cover(stage.find(action.name), false);
    case Verb::kLight:
      return stage.set_light(action.numbers[0]);
    case Verb::kCurrent:
      return parts.plant.set_current(parts.scenario.world_from_reference().rotation *
                                     metres(action));
    default:
      return;  // the daemon's business alone
  }
}

}  // namespace

Result<void> act(const Action& action, TimePoint now, Parts& parts) {
  if (act_on_cameras(action, now, parts.cameras)) return {};
  if (is_of_drives(action.verb)) {
    const int drive = static_cast<int>(std::max(0.0, action.numbers[0] - 1));
    if (parts.motors != nullptr && drive < parts.motors->count())
      act_on_drive(action, drive, parts);
    return {};
  }
  act_on_water(action, now, parts);
  return parts.motors == nullptr ? Result<void>() : act_on_bus(action, now, parts.motors->bus());
}

Result<void> check_events(const Scenario& scenario, const FrameSinkAbilities& cameras) {
  std::string problems;
  for (const Event& event : scenario.events) {
    const Verb verb = event.action.verb;
    const bool possible = verb == Verb::kShortFrames  ? cameras.short_frames
                          : verb == Verb::kFlagFrames ? cameras.error_flags
                          : verb == Verb::kSkewLeft || verb == Verb::kSkewRight ? cameras.two_stamps
                                                                                : true;
    if (!possible)
      problems += (problems.empty() ? "" : "\n") + ("'" + event.text + "'") +
                  ": the cameras of this run cannot play that (gannet-world --help says which can)";
  }
  if (!problems.empty()) return Error{problems};
  return {};
}

}  // namespace gannet::world
