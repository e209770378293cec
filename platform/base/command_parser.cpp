// parse() of command_line.hpp: a command's words checked against its table.
#include <algorithm>
#include <cassert>

#include "platform/base/command_line.hpp"
#include "platform/base/command_words.hpp"
#include "platform/base/nearest_word.hpp"

namespace gannet {
namespace {

bool is_numeric(ArgumentKind kind) {
  return kind != ArgumentKind::kText && kind != ArgumentKind::kFlag;
}

bool is_list(ArgumentKind kind) {
  return kind == ArgumentKind::kIntegers || kind == ArgumentKind::kNumbers;
}

bool is_whole(ArgumentKind kind) {
  return kind == ArgumentKind::kIntegers || kind == ArgumentKind::kInteger;
}

char separator(const Argument& a) { return a.value.find(':') != std::string::npos ? ':' : ','; }

// "" if the number is what the table allows.
std::string number_problem(const Argument& a, const std::string& text) {
  const auto number = number_from_text(text);
  if (!number) return "'" + text + "' is not a number";
  if (is_whole(a.kind) && !integer_from_text(text)) return "'" + text + "' is not a whole number";
  if (*number < a.min || *number > a.max)
    return text + (a.unit.empty() ? "" : " " + a.unit) + " is not " + range_text(a);
  return "";
}

std::string value_problem(const Argument& a, const std::string& text) {
  if (!a.choices.empty() && std::find(a.choices.begin(), a.choices.end(), text) == a.choices.end())
    return "'" + text + "' is none of " + joined(a.choices, ", ") + did_you_mean(text, a.choices);
  if (a.kind == ArgumentKind::kText && text.empty()) return "is empty";
  if (!is_numeric(a.kind)) return "";
  if (!is_list(a.kind)) return number_problem(a, text);
  const std::vector<std::string> parts = split(text, separator(a));
  if (a.count >= 0 && static_cast<int>(parts.size()) != a.count)
    return "'" + text + "' is not of the form " + a.value;
  for (const std::string& part : parts) {
    const std::string problem = number_problem(a, part);
    if (!problem.empty()) return problem;
  }
  return "";
}

// "-40,20,840" is a value, "-c" an option.
bool looks_like_option(const std::string& text) {
  if (text.size() < 2 || text[0] != '-') return false;
  return !(text[1] >= '0' && text[1] <= '9') && text[1] != '.';
}

std::string shown_name(const Argument& a) { return "--" + a.name; }

}  // namespace

class CommandParser {
 public:
  CommandParser(const Command& command, std::span<const std::string> args)
      : command_(command), args_(args) {
    for (const auto* table : {&command.options, &command.positionals})
      for (const Argument& a : *table) {
        arguments_.values_[a.name];
        arguments_.given_[a.name] = false;
      }
  }

  Result<Arguments> run() {
    bool options_end = false;
    while (next_ < args_.size()) {
      const std::string& text = args_[next_++];
      if (!options_end && text == "--") {
        options_end = true;
      } else if (!options_end && looks_like_option(text)) {
        take_option(text);
      } else {
        take_positional(text);
      }
    }
    finish();
    if (!problems_.empty()) return Error{problems_};
    return std::move(arguments_);
  }

 private:
  void refuse(const std::string& text) {
    problems_ += (problems_.empty() ? "" : "\n") + command_.name + ": " + text;
  }

  const Argument* find(const std::string& name, char letter) const {
    for (const Argument& a : command_.options)
      if ((letter != 0 && a.letter == letter) || (!name.empty() && a.name == name)) return &a;
    return nullptr;
  }

  void take_option(const std::string& text) {
    const bool is_long = text[1] == '-';
    const std::size_t equals = text.find('=');
    const std::string name = is_long ? text.substr(2, equals - 2) : "";
    const Argument* a = is_long ? find(name, 0) : text.size() == 2 ? find("", text[1]) : nullptr;
    if (a == nullptr) {
      // What follows was most likely meant as its value; to complain of that too would confuse.
      if (equals == std::string::npos && has_value_next()) ++next_;
      return refuse_unknown(text.substr(0, equals), name);
    }
    const bool has_value = is_long && equals != std::string::npos;
    if (a->kind == ArgumentKind::kFlag) {
      if (has_value) return refuse(shown_name(*a) + " takes no value");
      return take(*a, "", shown_name(*a));
    }
    if (has_value) return take(*a, text.substr(equals + 1), shown_name(*a));
    if (!has_value_next()) return refuse(shown_name(*a) + " needs a value: " + a->value);
    take(*a, args_[next_++], shown_name(*a));
  }

  bool has_value_next() const { return next_ < args_.size() && !looks_like_option(args_[next_]); }

  void refuse_unknown(const std::string& shown, const std::string& name) {
    std::vector<std::string> known = {"--help", "--version"};
    for (const Argument& a : command_.options) known.push_back("--" + a.name);
    refuse("unknown option " + shown + (name.empty() ? "" : did_you_mean("--" + name, known)));
  }

  void take_positional(const std::string& text) {
    for (const Argument& a : command_.positionals)
      if (!arguments_.given_[a.name] || a.repeats) return take(a, text, a.name);
    refuse("'" + text + "' is one argument too many");
  }

  void take(const Argument& a, const std::string& text, const std::string& shown) {
    if (arguments_.given_[a.name] && !a.repeats && a.kind != ArgumentKind::kFlag)
      return refuse(shown + " is given twice");
    arguments_.given_[a.name] = true;
    const std::string problem = value_problem(a, text);
    if (!problem.empty()) return refuse(shown + ": " + problem);
    arguments_.values_[a.name].push_back(text);
  }

  void finish() {
    for (const auto* table : {&command_.options, &command_.positionals})
      for (const Argument& a : *table) {
        if (arguments_.given_[a.name]) continue;
        const std::string name = table == &command_.options ? shown_name(a) : a.name;
        if (a.required) refuse(name + " is missing: " + a.help);
        if (a.preset.empty() || a.kind == ArgumentKind::kFlag) continue;
        assert(value_problem(a, a.preset).empty());
        arguments_.values_[a.name].push_back(a.preset);
      }
  }

  const Command& command_;
  std::span<const std::string> args_;
  std::size_t next_ = 0;
  Arguments arguments_;
  std::string problems_;
};

Result<Arguments> parse(const Command& command, std::span<const std::string> args) {
  return CommandParser(command, args).run();
}

}  // namespace gannet
