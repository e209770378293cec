// Action: what an event of a scenario does, read from a line as a person writes it; action_forms()
// lists the lines and what they mean. Positions in Σ_H; drives count from 1, as ArduSub counts
// motors. Start-up only.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "platform/base/result.hpp"

namespace gannet::world {

enum class Verb {
  kPressEstop,
  kReleaseEstop,
  kCutEstop,
  kArm,
  kDisarm,
  kReset,
  kStop,
  kTarget,
  kManual,
  kGoal,
  kMission,
  kBlind,
  kSee,
  kDrop,
  kOcclude,
  kUncover,
  kSilenceDrive,
  kFaultDrive,
  kJamDrive,
  kMendDrive,
  kLateDrive,
  kGarbageDrive,
  kFreezeCamera,
  kBackwardStamps,
  kShortFrames,
  kFlagFrames,
  kLateLeft,
  kLateRight,
  kSkewLeft,
  kSkewRight,
  kMendCamera,
  kBusOff,
  kBusPassive,
  kBusDown,
  kBusUp,
  kLight,
  kCurrent,
};

struct Action {
  Verb verb = Verb::kSee;
  std::string name;             // of the target
  std::vector<double> numbers;  // the rest
  std::string text;             // as it was written, single spaces

  bool is_operator_command() const;  // goes through the daemon's control socket
};

// Error: no such action, with the nearest; a number that is none.
Result<Action> parse_action(std::string_view text);

struct ActionForm {
  std::string_view words;      // "goal"
  std::string_view arguments;  // "X Y Z", a word each; "": none
  std::string_view meaning;
  Verb verb;
};
std::span<const ActionForm> action_forms();

// Words between blanks.
std::vector<std::string> words_of(std::string_view text);

}  // namespace gannet::world
