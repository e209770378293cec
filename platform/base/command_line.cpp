#include "platform/base/command_line.hpp"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "platform/base/nearest_word.hpp"

namespace gannet {
namespace {

const Argument kHelp{.name = "help",
                     .letter = 'h',
                     .kind = ArgumentKind::kFlag,
                     .help = "Print this help and exit."};
const Argument kVersion{
    .name = "version", .kind = ArgumentKind::kFlag, .help = "Print the version and exit."};

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

std::vector<std::string> split(std::string_view text, char at) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == at) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

std::string plain(double number) {
  char text[64];
  const auto format =
      std::abs(number) < 1e15 ? std::chars_format::fixed : std::chars_format::general;
  return {text, std::to_chars(text, text + sizeof text, number, format).ptr};
}

std::string range_text(const Argument& a) {
  const bool low = std::isfinite(a.min);
  const bool high = std::isfinite(a.max);
  if (low && high) return plain(a.min) + " to " + plain(a.max);
  if (low) return "at least " + plain(a.min);
  if (high) return "at most " + plain(a.max);
  return "";
}

std::string joined(const std::vector<std::string>& words, std::string_view between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : std::string(between)) + word;
  return text;
}

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

// ---- values -------------------------------------------------------------------------------------

const std::vector<std::string>& Arguments::values(std::string_view name) const {
  const auto found = values_.find(name);
  assert(found != values_.end());
  return found->second;
}

bool Arguments::given(std::string_view name) const {
  const auto found = given_.find(name);
  assert(found != given_.end());
  return found->second;
}

std::string Arguments::text(std::string_view name) const {
  return values(name).empty() ? "" : values(name).front();
}

std::vector<std::string> Arguments::texts(std::string_view name) const { return values(name); }

double Arguments::number(std::string_view name) const {
  assert(!values(name).empty());
  return *number_from_text(values(name).front());
}

int Arguments::integer(std::string_view name) const {
  assert(!values(name).empty());
  return *integer_from_text(values(name).front());
}

std::vector<double> Arguments::numbers(std::string_view name) const {
  if (values(name).empty()) return {};
  const std::string& text = values(name).front();
  std::vector<double> numbers;
  // The table is not here: whichever separator the value has is the one that it was checked with.
  for (const std::string& part : split(text, text.find(':') != std::string::npos ? ':' : ','))
    numbers.push_back(*number_from_text(part));
  return numbers;
}

std::vector<int> Arguments::integers(std::string_view name) const {
  std::vector<int> integers;
  for (const double number : numbers(name)) integers.push_back(static_cast<int>(number));
  return integers;
}

std::optional<double> number_from_text(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return {};
  if (!std::isfinite(number)) return {};
  return number;
}

std::optional<int> integer_from_text(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return {};
  return number;
}

// ---- help ---------------------------------------------------------------------------------------

namespace {

// "[mm, 10 to 10000; default 400]"
std::string facts(const Argument& a) {
  std::vector<std::string> facts;
  if (!a.unit.empty()) facts.push_back(a.unit);
  const std::string range = range_text(a);
  if (!range.empty()) facts.push_back(range);
  if (a.repeats) facts.push_back("may be repeated");
  std::string text = joined(facts, ", ");
  if (!a.preset.empty()) text += (text.empty() ? "" : "; ") + ("default " + a.preset);
  return text.empty() ? "" : " [" + text + "]";
}

std::string full_help(const Argument& a) {
  const std::string choices = a.choices.empty() ? "" : " One of " + joined(a.choices, ", ") + ".";
  return a.help + choices + facts(a);
}

std::string usage(const Command& command) {
  std::string text = command.name;
  if (!command.subcommands.empty()) text += " SUBCOMMAND …";
  for (const Argument& a : command.options)
    if (a.required) text += " --" + a.name + " " + a.value;
  text += " [options]";
  for (const Argument& a : command.positionals) {
    const std::string shown = a.name + (a.repeats ? " …" : "");
    text += " " + (a.required ? shown : "[" + shown + "]");
  }
  return text;
}

// Bytes that begin a character; continuation bytes of UTF-8 take no column.
std::size_t columns(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

std::string wrapped(std::string_view text, std::size_t indent) {
  const std::size_t width = 92;
  std::string out;
  std::size_t column = indent;
  for (const std::string& word : split(text, ' ')) {
    if (column > indent && column + 1 + columns(word) > width) {
      out += "\n" + std::string(indent, ' ');
      column = indent;
    }
    if (column > indent) {
      out += ' ';
      ++column;
    }
    out += word;
    column += columns(word);
  }
  return out;
}

std::string option_head(const Argument& a) {
  const std::string letter = a.letter != 0 ? std::string("-") + a.letter + ", " : "";
  return letter + "--" + a.name + (a.kind == ArgumentKind::kFlag ? "" : " " + a.value);
}

std::string help_entry(const std::string& head, const std::string& help) {
  const std::size_t indent = 28;
  std::string text = "  " + head;
  const std::size_t used = columns(text);
  text += used + 2 <= indent ? std::string(indent - used, ' ') : "\n" + std::string(indent, ' ');
  return text + wrapped(help, indent) + "\n";
}

std::string indented(const std::string& lines) {
  std::string text;
  for (const std::string& line : split(lines, '\n')) text += "  " + line + "\n";
  return text;
}

}  // namespace

std::string help_text(const Command& command) {
  std::string text = command.name + ": " + command.summary + "\n\nUsage: " + usage(command) + "\n";
  for (const std::string& paragraph : split(command.description, '\n'))
    if (!paragraph.empty()) text += "\n" + wrapped(paragraph, 0) + "\n";
  if (!command.subcommands.empty()) text += "\nSubcommands:\n";
  for (const auto& [words, summary] : command.subcommands) text += help_entry(words, summary);
  if (!command.positionals.empty()) text += "\nArguments:\n";
  for (const Argument& a : command.positionals) text += help_entry(a.name, full_help(a));
  text += "\nOptions:\n";
  for (const Argument& a : command.options) text += help_entry(option_head(a), full_help(a));
  for (const Argument* a : {&kHelp, &kVersion}) text += help_entry(option_head(*a), a->help);
  if (!command.example.empty()) text += "\nExample:\n" + indented(command.example);
  if (!command.exit_codes.empty()) text += "\nExit code:\n" + indented(command.exit_codes);
  return text;
}

// ---- man page -----------------------------------------------------------------------------------

namespace {

// Text for roff: backslash and hyphen keep their look, a line never begins with a command.
std::string roff(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool line_begins = out.empty() || out.back() == '\n';
    if (line_begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
  }
  return out;
}

std::string man_name(const Command& command) {
  std::string name = command.name;
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

std::string man_entry(const std::string& head, const Argument& a) {
  return ".TP\n.B " + roff(head) + "\n" + roff(full_help(a)) + "\n";
}

std::string literal(const std::string& lines) {
  return ".nf\n.RS 4\n" + roff(lines) + "\n.RE\n.fi\n";
}

}  // namespace

std::string man_page(const Command& command) {
  std::string text = ".\\\" Made from the program's own description; do not edit.\n";
  text += ".TH " + man_name(command) + " " + std::to_string(command.section) + " \"\" \"Gannet " +
          GANNET_VERSION + "\" \"Gannet\"\n";
  text += ".SH NAME\n" + roff(man_name(command)) + " \\- " + roff(command.summary) + "\n";
  text += ".SH SYNOPSIS\n.B " + roff(usage(command)) + "\n.SH DESCRIPTION\n";
  bool first = true;
  for (const std::string& paragraph : split(command.description, '\n')) {
    if (paragraph.empty()) continue;
    text += (first ? "" : ".PP\n") + roff(paragraph) + "\n";
    first = false;
  }
  for (const auto& [words, summary] : command.subcommands)
    text += ".TP\n.B " + roff(words) + "\n" + roff(summary) + "\n";
  for (const Argument& a : command.positionals) text += man_entry(a.name, a);
  text += ".SH OPTIONS\n";
  for (const Argument& a : command.options) text += man_entry(option_head(a), a);
  text += man_entry(option_head(kHelp), kHelp) + man_entry(option_head(kVersion), kVersion);
  if (!command.exit_codes.empty()) text += ".SH EXIT STATUS\n" + literal(command.exit_codes);
  if (!command.example.empty()) text += ".SH EXAMPLE\n" + literal(command.example);
  if (!command.see_also.empty()) text += ".SH SEE ALSO\n" + roff(command.see_also) + "\n";
  return text;
}

std::optional<int> begin_command(const Command& command, std::span<const std::string> args,
                                 Arguments& arguments) {
  for (const std::string& text : args) {
    std::string answer;
    if (text == "--help" || text == "-h") answer = help_text(command);
    if (text == "--version") answer = command.name + " " + GANNET_VERSION + "\n";
    if (text == "--man-page") answer = man_page(command);
    if (text == "--") break;
    if (answer.empty()) continue;
    std::fputs(answer.c_str(), stdout);
    return 0;
  }
  Result<Arguments> parsed = parse(command, args);
  if (!parsed) {
    std::fprintf(stderr, "%s\n", parsed.error().text.c_str());
    return 2;
  }
  arguments = std::move(*parsed);
  return std::nullopt;
}

}  // namespace gannet
