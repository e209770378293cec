#include "src/world/action.hpp"

#include <cstddef>

#include "platform/base/command_line.hpp"

namespace gannet::world {
namespace {

// NAME takes a word, anything else a number.
constexpr ActionForm kForms[] = {
    {"press estop", "", "press the e-stop", Verb::kPressEstop},
    {"release estop", "", "release it", Verb::kReleaseEstop},
    {"cut estop", "", "break a wire of its first contact", Verb::kCutEstop},
    {"arm", "", "as the operator, like the seven below", Verb::kArm},
    {"disarm", "", "", Verb::kDisarm},
    {"reset", "", "", Verb::kReset},
    {"stop", "", "", Verb::kStop},
    {"target", "NAME", "none is no target", Verb::kTarget},
    {"manual", "X Y Z", "steer by hand for safety.manual_age_s: forward, left, up, mm/s",
     Verb::kManual},
    {"goal", "X Y Z", "where the target shall be, mm", Verb::kGoal},
    {"mission", "NAME", "start or stop", Verb::kMission},
    {"blind", "", "the cameras give nothing", Verb::kBlind},
    {"see", "", "ends blind and drop", Verb::kSee},
    {"drop", "SHARE", "this share of the pairs, at random", Verb::kDrop},
    {"freeze camera", "", "the last pair comes again and again, with its stamps",
     Verb::kFreezeCamera},
    {"backward stamps", "", "the pairs' stamps run backwards", Verb::kBackwardStamps},
    {"short frames", "", "a third of the bytes; not in shared memory", Verb::kShortFrames},
    {"flag frames", "", "damaged by the driver's word; neither shared memory nor v4l2loopback can",
     Verb::kFlagFrames},
    {"late left", "MS", "the left image comes later, its stamp is true", Verb::kLateLeft},
    {"late right", "MS", "the right one", Verb::kLateRight},
    {"skew left", "MS", "the left image says that it was exposed later; not in shared memory",
     Verb::kSkewLeft},
    {"skew right", "MS", "the right one", Verb::kSkewRight},
    {"thaw camera", "", "as mend camera", Verb::kMendCamera},
    {"mend camera", "", "ends freeze, backward, short, late and skew", Verb::kMendCamera},
    {"occlude", "NAME", "something hides the target", Verb::kOcclude},
    {"uncover", "NAME", "", Verb::kUncover},
    {"silence drive", "N", "it is off the bus", Verb::kSilenceDrive},
    {"fault drive", "N", "it stands and says so", Verb::kFaultDrive},
    {"jam drive", "N", "its propeller is stuck", Verb::kJamDrive},
    {"late drive", "N MS", "what it says comes later", Verb::kLateDrive},
    {"garbage drive", "N SHARE", "this share of its frames is noise", Verb::kGarbageDrive},
    {"mend drive", "N", "ends all of these", Verb::kMendDrive},
    {"bus off", "", "the daemon's CAN controller goes off the bus", Verb::kBusOff},
    {"bus passive", "", "it counts too many errors and says so", Verb::kBusPassive},
    {"bus down", "", "the interface goes down", Verb::kBusDown},
    {"bus up", "", "ends these", Verb::kBusUp},
    {"light", "LUX", "", Verb::kLight},
    {"current", "X Y Z", "of the water, mm/s", Verb::kCurrent},
};

bool begins_with(const std::vector<std::string>& words, const std::vector<std::string>& head) {
  return words.size() >= head.size() && std::equal(head.begin(), head.end(), words.begin());
}

std::string all_forms() {
  std::string text;
  for (const ActionForm& form : kForms)
    text += (text.empty() ? "" : ", ") + std::string(form.words);
  return text;
}

Result<Action> read_arguments(const ActionForm& form, std::size_t first,
                              const std::vector<std::string>& words, std::string_view text) {
  const std::string what = "'" + std::string(text) + "': '";
  const std::vector<std::string> names = words_of(form.arguments);
  if (words.size() != first + names.size())
    return Error{what + std::string(form.words) + "' takes " + std::to_string(names.size()) +
                 " more word(s)"};
  Action action;
  action.verb = form.verb;
  for (std::size_t i = 0; i < words.size(); ++i) {
    action.text += (i == 0 ? "" : " ") + words[i];
    if (i < first) continue;
    if (names[i - first] == "NAME") {
      action.name = words[i];
    } else if (const auto number = number_from_text(words[i])) {
      action.numbers.push_back(*number);
    } else {
      return Error{what + words[i] + "' is no number"};
    }
  }
  return action;
}

}  // namespace

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : text) {
    if (c != ' ' && c != '\t') {
      word += c;
    } else if (!word.empty()) {
      words.push_back(std::move(word));
      word.clear();
    }
  }
  if (!word.empty()) words.push_back(std::move(word));
  return words;
}

std::span<const ActionForm> action_forms() { return kForms; }

bool Action::is_operator_command() const { return verb >= Verb::kArm && verb <= Verb::kMission; }

Result<Action> parse_action(std::string_view text) {
  const std::vector<std::string> words = words_of(text);
  for (const ActionForm& form : kForms) {
    const std::vector<std::string> head = words_of(form.words);
    if (begins_with(words, head)) return read_arguments(form, head.size(), words, text);
  }
  return Error{"'" + std::string(text) + "' is no action; there are: " + all_forms()};
}

}  // namespace gannet::world
