// A command's line, described once: from one table come the parser (all errors at once), --help
// and the man page. Values are checked against the table, so that a program reads them without
// asking again. Start-up only.
//
//   const Command kLocate = {
//       .name = "gannet locate",
//       .summary = "pose of a target in one stereo pair",
//       .options = {{.name = "left", .value = "FILE", .required = true, .help = "Left image."},
//                   {.name = "z-mm", .kind = ArgumentKind::kNumbers, .value = "NEAR:FAR",
//                    .count = 2, .min = 10, .unit = "mm", .preset = "400:1000", .help = "…"}},
//       .example = "gannet locate --rig rig.toml --left l.png …"};
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "platform/base/result.hpp"

namespace gannet {

enum class ArgumentKind { kText, kFlag, kInteger, kNumber, kIntegers, kNumbers };

// One option, or one positional argument (required and repeats as for options, no letter).
struct Argument {
  std::string name;  // "z-mm" is typed --z-mm
  char letter = 0;   // 'c': -c is the same
  ArgumentKind kind = ArgumentKind::kText;
  std::string value = "";  // how help names the value: FILE, NEAR:FAR; also tells
                           // the separator of kNumbers: ':' if there is one
  int count = -1;          // of kIntegers and kNumbers
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::vector<std::string> choices = {};
  std::string unit = "";
  std::string preset = "";  // what holds if it is not given, as a person types it
  bool required = false;
  bool repeats = false;
  std::string help = "";  // a sentence
};

struct Command {
  std::string name;              // "gannet locate"
  std::string summary;           // half a sentence, for lists and the man page's head
  std::string description = "";  // paragraphs, an empty line between them
  std::vector<Argument> options = {};
  std::vector<Argument> positionals = {};
  std::vector<std::pair<std::string, std::string>> subcommands = {};  // words, summary
  std::string example = "";                                           // lines that can be typed
  std::string exit_codes = "";                                        // "0  found\n1  not found"
  std::string see_also = "";                                          // "gannet(1), gannet.toml(5)"
  int section = 1;                                                    // of the manual
};

// What was given, or the presets. Asking for a name that the table does not have is a bug.
class Arguments {
 public:
  bool knows(std::string_view name) const { return given_.count(name) > 0; }  // in the table
  bool given(std::string_view name) const;                                    // typed by the person
  bool flag(std::string_view name) const { return given(name); }
  std::string text(std::string_view name) const;                // "" if absent and without preset
  std::vector<std::string> texts(std::string_view name) const;  // in order, of one that repeats
  double number(std::string_view name) const;
  int integer(std::string_view name) const;
  std::vector<double> numbers(std::string_view name) const;  // empty if absent
  std::vector<int> integers(std::string_view name) const;

 private:
  friend class CommandParser;
  const std::vector<std::string>& values(std::string_view name) const;
  std::map<std::string, std::vector<std::string>, std::less<>> values_;  // every name of the table
  std::map<std::string, bool, std::less<>> given_;
};

// args without the program's name. Error: a line for each problem, each beginning with the
// command's name. --name value, --name=value and -n value are the same; "--" ends the options.
Result<Arguments> parse(const Command& command, std::span<const std::string> args);

std::string help_text(const Command& command);
std::string man_page(const Command& command);  // roff

// The front door of a program: answers --help, --version and --man-page on standard output and
// reports errors on standard error. Returns the exit code if there is nothing left to do (0 or 2).
std::optional<int> begin_command(const Command& command, std::span<const std::string> args,
                                 Arguments& arguments);

// A number as a person types it, the whole text; no locale. Empty when it is none or not finite.
std::optional<double> number_from_text(std::string_view text);
std::optional<int> integer_from_text(std::string_view text);

}  // namespace gannet
