// Action: what an event of a scenario does, read from a line as a person writes it:
//   press estop · release estop · cut estop (the line is not readable) · arm · disarm · reset ·
//   stop target NAME · target none · goal X Y Z (mm) · blind · see · drop SHARE · occlude NAME ·
//   uncover NAME · silence drive N · fault drive N · jam drive N · mend drive N · light LUX ·
//   current X Y Z (mm/s)
// Positions in Σ_H; drives count from 1, as ArduSub counts motors. Start-up only.
#pragma once

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
  kGoal,
  kBlind,
  kSee,
  kDrop,
  kOcclude,
  kUncover,
  kSilenceDrive,
  kFaultDrive,
  kJamDrive,
  kMendDrive,
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

// Words between blanks.
std::vector<std::string> words_of(std::string_view text);

}  // namespace gannet::world
