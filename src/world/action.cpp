#include "src/world/action.hpp"

#include <cstddef>

#include "platform/base/command_line.hpp"

namespace gannet::world {
namespace {

enum class Takes { kNothing, kName, kNumbers };

struct Form {
  std::string_view words;
  Verb verb;
  Takes takes = Takes::kNothing;
  std::size_t count = 0;
};

constexpr Form kForms[] = {
    {"press estop", Verb::kPressEstop},
    {"release estop", Verb::kReleaseEstop},
    {"cut estop", Verb::kCutEstop},
    {"arm", Verb::kArm},
    {"disarm", Verb::kDisarm},
    {"reset", Verb::kReset},
    {"stop", Verb::kStop},
    {"target", Verb::kTarget, Takes::kName, 1},
    {"goal", Verb::kGoal, Takes::kNumbers, 3},
    {"blind", Verb::kBlind},
    {"see", Verb::kSee},
    {"drop", Verb::kDrop, Takes::kNumbers, 1},
    {"occlude", Verb::kOcclude, Takes::kName, 1},
    {"uncover", Verb::kUncover, Takes::kName, 1},
    {"silence drive", Verb::kSilenceDrive, Takes::kNumbers, 1},
    {"fault drive", Verb::kFaultDrive, Takes::kNumbers, 1},
    {"jam drive", Verb::kJamDrive, Takes::kNumbers, 1},
    {"mend drive", Verb::kMendDrive, Takes::kNumbers, 1},
    {"light", Verb::kLight, Takes::kNumbers, 1},
    {"current", Verb::kCurrent, Takes::kNumbers, 3},
};

bool begins_with(const std::vector<std::string>& words, const std::vector<std::string>& head) {
  return words.size() >= head.size() && std::equal(head.begin(), head.end(), words.begin());
}

std::string all_forms() {
  std::string text;
  for (const Form& form : kForms) text += (text.empty() ? "" : ", ") + std::string(form.words);
  return text;
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

bool Action::is_operator_command() const { return verb >= Verb::kArm && verb <= Verb::kGoal; }

Result<Action> parse_action(std::string_view text) {
  const std::vector<std::string> words = words_of(text);
  for (const Form& form : kForms) {
    const std::vector<std::string> head = words_of(form.words);
    if (!begins_with(words, head)) continue;
    if (words.size() != head.size() + form.count)
      return Error{"'" + std::string(text) + "': '" + std::string(form.words) + "' takes " +
                   std::to_string(form.count) + " more word(s)"};
    Action action;
    action.verb = form.verb;
    for (std::size_t i = 0; i < words.size(); ++i) {
      action.text += (i == 0 ? "" : " ") + words[i];
      if (i < head.size()) continue;
      if (form.takes == Takes::kName) {
        action.name = words[i];
      } else if (const auto number = number_from_text(words[i])) {
        action.numbers.push_back(*number);
      } else {
        return Error{"'" + std::string(text) + "': '" + words[i] + "' is no number"};
      }
    }
    return action;
  }
  return Error{"'" + std::string(text) + "' is no action; there are: " + all_forms()};
}

}  // namespace gannet::world
