#include "src/tool/subcommands.hpp"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "hal/drive/cia402_objects.hpp"
#include "hal/drive/dronecan_names.hpp"
#include "hal/drive/odrive_messages.hpp"
#include "hal/drive/vesc_messages.hpp"
#include "platform/base/nearest_word.hpp"
#include "src/config/daemon_config.hpp"
#include "src/config/rig_file.hpp"
#include "src/tool/cameras.hpp"
#include "src/tool/offline.hpp"
#include "src/tool/online.hpp"

namespace gannet::tool {
namespace {

constexpr std::string_view kPrefix = "gannet ";

Command top_command() {
  Command command = {.name = "gannet",
                     .summary =
                         "builds models of targets, finds them in stereo images, and talks "
                         "to gannetd",
                     .description = "Each subcommand has its own --help and manual page."};
  for (const Subcommand& sub : subcommands()) {
    command.subcommands.emplace_back(sub.command.name.substr(kPrefix.size()), sub.command.summary);
    std::string page = sub.command.name;
    std::replace(page.begin(), page.end(), ' ', '-');
    command.see_also += page + "(1), ";
  }
  command.see_also += "gannetd(8), gannet-world(1), gannet.toml(5)";
  command.example = "gannet model build --help";
  return command;
}

// `gannet model`, `gannet config`: the first word of some; without subcommands: of none.
Command group_command(const std::string& word) {
  Command group = {.name = "gannet " + word, .summary = "a group of subcommands"};
  const std::string prefix = group.name + " ";
  for (const Subcommand& sub : subcommands())
    if (sub.command.name.rfind(prefix, 0) == 0)
      group.subcommands.emplace_back(sub.command.name.substr(prefix.size()), sub.command.summary);
  return group;
}

// How many of the first words make this subcommand's name; 0: they do not.
std::size_t matched_words(const Subcommand& sub, std::span<const std::string> args) {
  std::string words = "gannet";
  for (std::size_t n = 1; n <= args.size() && n <= 2; ++n) {
    words += " " + args[n - 1];
    if (words == sub.command.name) return n;
  }
  return 0;
}

int run_subcommand(const Subcommand& sub, std::span<const std::string> args) {
  const bool asks = std::any_of(args.begin(), args.end(), [](const std::string& arg) {
    return arg == "--help" || arg == "-h" || arg == "--version" || arg == "--man-page";
  });
  if (!asks && sub.tell_bad_arguments != nullptr) {
    const Result<Arguments> parsed = parse(sub.command, args);
    if (!parsed) sub.tell_bad_arguments(args, parsed.error().text);
  }
  Arguments arguments;
  if (const auto code = begin_command(sub.command, args, arguments)) return *code;
  return sub.run(arguments);
}

std::string usage_hint(const std::string& word) {
  std::vector<std::string> known;
  for (const Subcommand& sub : subcommands())
    known.push_back(sub.command.name.substr(kPrefix.size()));
  return "'" + word + "' is no subcommand" + did_you_mean(word, known) +
         "; `gannet --help` lists them";
}

// `gannet --reference NAME`, for `make docs`: what is written of files, and the subcommands' words.
int print_reference(const std::string& name) {
  std::string text;
  if (name == "gannet.toml.5") text = config::config_man_page();
  if (name == "gannet.toml.md") text = config::config_markdown();
  if (name == "gannet-cia402.eds") text = hal::cia402::eds_text();
  if (name == "vesc.dbc") text = hal::vesc::dbc_text();
  if (name == "odrive.dbc") text = hal::odrive::dbc_text();
  if (name == "dronecan.md") text = hal::dronecan::reference_text();
  if (name == "rig.md")
    text =
        "# RIG files\n\nThe calibration of two cameras. The keys of [left], [right] and "
        "[right_from_left] must be given, all but distortion, coefficients and time_offset_s; "
        "the defaults of the others are examples. A [left.port] or [right.port] that is there "
        "must tell normal, distance_m and thickness_m. Made from the program's own description by "
        "`make docs`; do not edit.\n" +
        config::rig_reference();
  if (name == "subcommands")
    for (const Subcommand& sub : subcommands())
      text += sub.command.name.substr(kPrefix.size()) + "\n";
  std::fputs(text.c_str(), stdout);
  return text.empty() ? 2 : 0;
}

}  // namespace

std::span<const Subcommand> subcommands() {
  static const std::vector<Subcommand> kTable = [] {
    std::vector<Subcommand> table = {model_build_subcommand(),
                                     model_list_subcommand(),
                                     model_show_subcommand(),
                                     locate_subcommand(),
                                     which_subcommand(),
                                     track_subcommand(),
                                     map_subcommand(),
                                     report_subcommand(),
                                     cameras_subcommand(),
                                     campaign_merge_subcommand(),
                                     campaign_report_subcommand()};
    const std::vector<Subcommand> online = online_subcommands();
    table.insert(table.end(), online.begin(), online.end());
    return table;
  }();
  return kTable;
}

int run_gannet(std::span<const std::string> args) {
  const Subcommand* best = nullptr;
  std::size_t most = 0;
  for (const Subcommand& sub : subcommands()) {
    const std::size_t n = matched_words(sub, args);
    if (n <= most) continue;
    most = n;
    best = &sub;
  }
  if (best != nullptr) return run_subcommand(*best, args.subspan(most));
  if (args.size() == 2 && args[0] == "--reference") return print_reference(args[1]);
  Arguments arguments;
  if (args.size() == 2 && (args[1] == "--help" || args[1] == "-h")) {
    const Command group = group_command(args[0]);
    if (!group.subcommands.empty())
      return begin_command(group, args.subspan(1), arguments).value_or(2);
  }
  if (args.empty() || args[0].rfind('-', 0) != 0) {
    const std::string problem =
        args.empty() ? "a subcommand is missing; `gannet --help` lists them" : usage_hint(args[0]);
    std::fprintf(stderr, "gannet: %s\n", problem.c_str());
    return 2;
  }
  return begin_command(top_command(), args, arguments).value_or(2);
}

}  // namespace gannet::tool
