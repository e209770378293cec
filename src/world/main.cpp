// gannet-world: runs a scenario with a real gannetd and says whether all its checks passed.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <span>
#include <string>
#include <vector>

#include "platform/base/command_line.hpp"
#include "platform/linux/clock.hpp"
#include "src/report/progress.hpp"
#include "src/world/album.hpp"
#include "src/world/assets.hpp"
#include "src/world/daemon_process.hpp"
#include "src/world/fitness_maps.hpp"
#include "src/world/paper_command.hpp"
#include "src/world/reactions.hpp"
#include "src/world/run_record.hpp"
#include "src/world/scenario.hpp"
#include "src/world/simulation.hpp"

namespace gannet::world {
namespace {

std::string events_help() {
  std::string text;
  for (const ActionForm& form : action_forms()) {
    text += (text.empty() ? "" : "; ") + std::string(form.words);
    if (!form.arguments.empty()) text += " " + std::string(form.arguments);
    if (!form.meaning.empty()) text += " (" + std::string(form.meaning) + ")";
  }
  return text + ".";
}

std::string measures_help() {
  std::string text;
  for (const Measure& measure : measures())
    text += std::string(measure.name) + " (" + measure.meaning + "); ";
  return text +
         "or 'permit none within 20 ms of press estop' (the drives are told to stand still), "
         "'state faulted within 600 ms of bus off' or 'of daemon gone', 'state is stopped at 5 s', "
         "'counted can_restarts = 1' (a counter of gannet top, at the end).";
}

Command command() {
  return {
      .name = "gannet-world",
      .summary = "run a scenario in a simulated world with a real gannetd",
      .description =
          "Simulates vehicle, water, cameras and motors of a scenario, starts gannetd in it and "
          "judges what came of it. The daemon hears of the world only by frames, CAN, lines and, "
          "in stepped time, the step socket.\n\nIn stepped time everything repeats bit for bit "
          "however busy the machine is; live, the daemon's threads run by the clock.\n\n"
          "Live, its devices can be the kernel's own: --cameras, --can and --lines. Reaction "
          "times are then taken from the stamps that the kernel gave the frames on the bus.\n\n"
          "Events of a scenario: " +
          events_help() + "\n\nMeasures of its checks: " + measures_help(),
      .options =
          {{.name = "stepped", .kind = ArgumentKind::kFlag, .help = "Stepped time, the default."},
           {.name = "live", .kind = ArgumentKind::kFlag, .help = "The machine's own time."},
           {.name = "record",
            .value = "DIR",
            .help = "Write result.json, trace.csv, events.csv, the daemon's log, its config, "
                    "rig and models here; `gannet report` makes a page of them."},
           {.name = "keep-every",
            .kind = ArgumentKind::kInteger,
            .value = "N",
            .min = 0,
            .max = 1000000,
            .unit = "frames",
            .preset = "0",
            .help = "With --record: keep each N-th pair in DIR/frames, 0: none."},
           {.name = "duration-s",
            .kind = ArgumentKind::kNumber,
            .value = "S",
            .min = 0.1,
            .max = 86400,
            .unit = "s",
            .help = "How long to run; the scenario's own if absent."},
           {.name = "seed",
            .kind = ArgumentKind::kInteger,
            .value = "N",
            .min = 0,
            .help = "Of noise and random motion; the scenario's own if absent."},
           {.name = "set",
            .value = "ROOM.KEY=VALUE",
            .repeats = true,
            .help = "Handed to gannetd after what the scenario sets."},
           {.name = "gannetd",
            .value = "PATH",
            .help = "The daemon; the one beside this program if absent."},
           {.name = "attach",
            .value = "DIR",
            .help = "Start no daemon: make DIR, write gannetd.toml, its drop-in with the "
                    "scenario's settings, rig and models into it, and wait for 'gannetd -c "
                    "DIR/gannetd.toml'. Live, the run goes on when that daemon dies, and with "
                    "the one that is started after it."},
           {.name = "control",
            .value = "PATH",
            .help = "The daemon's control socket; one in the run's folder if absent."},
           {.name = "cameras",
            .value = "v4l2:LEFT,RIGHT",
            .help = "With --live: two devices of v4l2loopback in the place of shared memory."},
           {.name = "can",
            .value = "socketcan:INTERFACE",
            .help = "With --live: an interface such as vcan0 in the place of a local bus. 'bus "
                    "down' and 'bus up' need CAP_NET_ADMIN."},
           {.name = "lines",
            .value = "gpio-sim:DIR",
            .help = "With --live: the sysfs folder of a chip of gpio-sim, with sim_gpio0 "
                    "(e-stop), 1 (its second contact), 2 (release) and 3 (light), in the place of "
                    "a mapped file."},
           {.name = "album",
            .value = "DIR",
            .help = "Run no scenario: make the model database of P001 Fig. 5, six creatures from "
                    "two sides each, as DIR/models/*.gannet, and DIR/rig.toml."},
           {.name = "pairs",
            .kind = ArgumentKind::kInteger,
            .value = "N",
            .min = 0,
            .max = 100000,
            .unit = "pairs",
            .preset = "0",
            .help = "With --album: so many pictures of one of them each, DIR/pairs/left and right, "
                    "and DIR/pairs/truth.csv, for `gannet which`."},
           {.name = "maps",
            .kind = ArgumentKind::kFlag,
            .help = "With --album: show how each model's fitness is distributed over x and y, as "
                    "P001 Fig. 6 does: DIR/maps.html with the maps as pictures, alone and among "
                    "others, by our fitness and the paper's; DIR/maps.csv with their peaks."},
           {.name = "assets",
            .value = "DIR",
            .help = "The photographs; $GANNET_ASSETS or build/assets if absent."}},
      .positionals = {{.name = "scenario",
                       .value = "SCENARIO",
                       .help = "A TOML file, or the name of one that is shipped."}},
      .example = "gannet-world rov_station_keeping --stepped --record out",
      .exit_codes =
          "0  all checks passed\n1  a check failed\n2  bad scenario or option\n"
          "3  the run broke off",
      .see_also = "gannet-world-paper(1), gannetd(8), gannet(1)"};
}

int fail(int code, const std::string& text) {
  std::fprintf(stderr, "gannet-world: %s\n", text.c_str());
  return code;
}

// The daemon's last words, which mostly tell why a run broke off.
void show_log(const RunFiles& files) {
  if (std::FILE* log = std::fopen(files.log().c_str(), "r")) {
    char line[1024];
    while (std::fgets(line, sizeof line, log) != nullptr) std::fprintf(stderr, "  | %s", line);
    std::fclose(log);
  }
}

// What the daemon was given and what it said; the folder of the run itself is temporary.
void keep_files(const RunFiles& files, const std::filesystem::path& folder) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(files.folder(), error)) {
    const std::string end = entry.path().extension().string();
    if (end != ".toml" && end != ".log" && end != ".gannet") continue;
    std::filesystem::copy_file(entry.path(), folder / entry.path().filename(),
                               std::filesystem::copy_options::overwrite_existing, error);
  }
}

// Where find_scenario has looked, in its order.
std::string not_there(const std::string& name, const std::string& path,
                      const std::string& program) {
  if (path == name) return "there is no file '" + name + "'";
  const char* asked = std::getenv("GANNET_SCENARIOS");
  return "there is no scenario '" + name + "': no " + path + " in " +
         (asked != nullptr ? std::string(asked) + ", " : "") + "tests/scenarios, " +
         program.substr(0, program.rfind('/') + 1) +
         "../share/gannet/scenarios; give its file, or set GANNET_SCENARIOS to its folder";
}

int run_maps(const std::string& folder, const std::string& assets, std::uint64_t seed,
             Parallel& parallel) {
  const auto maps = make_fitness_maps(folder, assets, seed, parallel);
  if (!maps) return fail(3, maps.error().text);
  std::printf("wrote %zu maps to %s/maps.html\n", maps->size(), folder.c_str());
  return 0;
}

int run_album(const Arguments& arguments) {
  const std::string assets = arguments.given("assets") ? arguments.text("assets") : assets_folder();
  const auto seed = static_cast<std::uint64_t>(arguments.given("seed") ? arguments.integer("seed")
                                                                       : Scenario().seed);
  Serial serial;
  const auto album =
      make_album(arguments.text("album"), assets, arguments.integer("pairs"), seed, serial);
  if (!album) return fail(3, album.error().text);
  for (const std::string& note : album->notes) std::printf("  %s\n", note.c_str());
  std::printf("wrote %d models and %d pairs below %s\n", album->models, arguments.integer("pairs"),
              arguments.text("album").c_str());
  return arguments.flag("maps") ? run_maps(arguments.text("album"), assets, seed, serial) : 0;
}

int run(const Arguments& arguments, const std::string& program) {
  if (arguments.given("album") == arguments.given("scenario"))
    return fail(2, arguments.given("album") ? "--album runs no scenario: leave it away"
                                            : "SCENARIO is missing");
  if (arguments.given("album")) return run_album(arguments);
  const std::string path = find_scenario(arguments.text("scenario"), program);
  if (std::error_code error; !std::filesystem::exists(path, error))
    return fail(2, not_there(arguments.text("scenario"), path, program));
  auto scenario = load_scenario(path);
  if (!scenario) return fail(2, scenario.error().text);
  if (arguments.given("seed")) scenario->seed = arguments.integer("seed");
  if (arguments.given("duration-s")) scenario->duration_s = arguments.number("duration-s");
  for (const std::string& setting : arguments.texts("set"))
    scenario->daemon.settings.push_back(setting);

  SimulationOptions options;
  options.stepped = !arguments.flag("live");
  options.assets = arguments.given("assets") ? arguments.text("assets") : assets_folder();
  options.folder = arguments.text("attach");
  if (arguments.given("record")) {
    options.keep_folder = arguments.text("record") + "/frames";
    options.keep_every = arguments.integer("keep-every");
  }
  if (!arguments.given("attach"))
    options.gannetd =
        arguments.given("gannetd") ? arguments.text("gannetd") : gannetd_beside(program);
  else
    options.patience = std::chrono::minutes(10);

  const auto ends =
      parse_ends(arguments.text("cameras"), arguments.text("can"), arguments.text("lines"));
  if (!ends) return fail(2, ends.error().text);
  options.ends = *ends;
  options.control = arguments.text("control");

  auto simulation = Simulation::create(*scenario, options);
  if (!simulation) return fail(3, simulation.error().text);
  std::printf("%s: %s\n", scenario->name.c_str(), scenario->description.c_str());
  for (const std::string& note : (*simulation)->notes()) std::printf("  %s\n", note.c_str());
  if (arguments.given("attach"))
    std::printf("waiting for: gannetd -c %s\n", (*simulation)->files().config().c_str());
  std::fflush(stdout);

  constexpr double kThousandths = 1000;
  report::Progress progress(std::cerr, report::is_terminal(2), scenario->name,
                            std::lround(scenario->duration_s * kThousandths),
                            linux_os::monotonic_now());
  auto result = (*simulation)->run([&](const TraceRow& row) {
    progress.update(std::lround(row.time_s * kThousandths), linux_os::monotonic_now());
  });
  progress.finish(linux_os::monotonic_now());
  if (arguments.given("record")) {
    if (result) {
      const auto written =
          write_record(arguments.text("record"), *scenario, *result, options.stepped);
      if (!written) return fail(3, written.error().text);
    }
    keep_files((*simulation)->files(), arguments.text("record"));
  }
  if (!result) {
    show_log((*simulation)->files());
    return fail(3, result.error().text);
  }
  std::printf("%s\n%s\n%s\n", result_table(*result).c_str(), reactions_table(result->trace).c_str(),
              timing_table(*result).c_str());
  std::printf("%s: %s after %.1f s of simulated and %.1f s of real time\n", scenario->name.c_str(),
              result->passed() ? "passed" : "FAILED", scenario->duration_s, result->host_s);
  return result->passed() ? 0 : 1;
}

}  // namespace
}  // namespace gannet::world

int main(int argc, char** argv) {
  using namespace gannet;
  const std::vector<std::string> args(argv + 1, argv + argc);
  if (!args.empty() && args[0] == "paper")
    return world::run_paper_command(argv[0], std::span(args).subspan(1));
  Arguments arguments;
  if (const auto code = begin_command(world::command(), args, arguments)) return *code;
  return world::run(arguments, argv[0]);
}
