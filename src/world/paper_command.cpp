#include "src/world/paper_command.hpp"

#include <cstdio>
#include <filesystem>
#include <iostream>

#include "platform/linux/clock.hpp"
#include "platform/linux/whole_file.hpp"
#include "src/report/progress.hpp"
#include "src/report/table.hpp"
#include "src/world/assets.hpp"
#include "src/world/daemon_process.hpp"
#include "src/world/paper_run.hpp"

namespace gannet::world {
namespace {

int fail(int code, const std::string& text) {
  std::fprintf(stderr, "gannet-world paper: %s\n", text.c_str());
  return code;
}

std::string names() {
  std::string text;
  for (const PaperExperiment& experiment : paper_experiments())
    text += (text.empty() ? "" : ", ") + std::string(experiment.name);
  return text;
}

void tell_experiments() {
  report::Table table({"experiment", "paper", "what"});
  for (const PaperExperiment& experiment : paper_experiments())
    table.add({experiment.name, experiment.paper, experiment.what});
  std::printf("%s", table.text().c_str());
}

std::vector<PaperMethod> methods_of(const std::string& word) {
  if (word == "both") return {PaperMethod::kOurs, PaperMethod::kPapers};
  return {word == "papers" ? PaperMethod::kPapers : PaperMethod::kOurs};
}

const char* word_of(PaperMethod method) { return kPaperMethods[static_cast<std::size_t>(method)]; }

// Seed by seed, so that a campaign that is cut short has whole seeds.
void tell_jobs(const std::string& program, const Arguments& arguments,
               const PaperExperiment* only) {
  const std::string folder = arguments.text("jobs");
  for (int seed = 1; seed <= arguments.integer("seeds"); ++seed) {
    for (const PaperMethod method : methods_of(arguments.text("method"))) {
      for (const PaperExperiment& experiment : paper_experiments()) {
        if (only != nullptr && only != &experiment) continue;
        std::printf("%s paper %s --method %s --seed %d -o %s/%s.%s.%d.json\n", program.c_str(),
                    experiment.name, word_of(method), seed, folder.c_str(), experiment.name,
                    word_of(method), seed);
      }
    }
  }
}

void tell_figures(const PaperRequest& request, const PaperResult& result) {
  report::Table table({"figure", "unit", "theirs", "ours", "allowed", "goal"});
  const auto verdict = [](const Bounds& bounds, double value) -> std::string {
    return !bounds.any() ? "" : bounds.hold(value) ? "pass" : "fail";
  };
  for (const PaperValue& value : result.values)
    table.add({value.figure->name, value.figure->unit, value.figure->theirs,
               report::number(value.value, 3), verdict(value.figure->allowed, value.value),
               verdict(value.figure->goal, value.value)});
  std::printf("%s, %s, seed %d: %s\n%s%d frames, %.0f s\n", request.experiment->name,
              word_of(request.method), request.seed, request.experiment->what, table.text().c_str(),
              result.trials, result.host_s);
}

Result<void> write_result(const PaperRequest& request, const PaperResult& result,
                          const std::string& path) {
  std::error_code error;
  const auto folder = std::filesystem::path(path).parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) return Error{folder.string() + ": " + error.message()};
  return linux_os::write_file(path, paper_json(request, result).dump(1) + "\n");
}

int run_one(const std::string& program, const Arguments& arguments,
            const PaperExperiment& experiment) {
  PaperRequest request = {.experiment = &experiment,
                          .method = methods_of(arguments.text("method")).front(),
                          .seed = arguments.integer("seed"),
                          .program = program,
                          .options = {},
                          .record = arguments.text("record")};
  request.options.assets = arguments.given("assets") ? arguments.text("assets") : assets_folder();
  request.options.gannetd =
      arguments.given("gannetd") ? arguments.text("gannetd") : gannetd_beside(program);
  std::optional<report::Progress> progress;
  const auto result = run_paper(request, [&](long done, long total) {
    const TimePoint now = linux_os::monotonic_now();
    if (!progress) progress.emplace(std::cerr, report::is_terminal(2), experiment.name, total, now);
    progress->update(done, now);
  });
  if (progress) progress->finish(linux_os::monotonic_now());
  if (!result) return fail(3, result.error().text);
  tell_figures(request, *result);
  if (!arguments.given("output")) return 0;
  const auto written = write_result(request, *result, arguments.text("output"));
  return written ? 0 : fail(3, written.error().text);
}

}  // namespace

Command paper_command() {
  return {
      .name = "gannet-world paper",
      .summary = "run an experiment of the papers",
      .description =
          "Runs one experiment with one method and one seed in stepped time, prints its figures "
          "beside the paper's, and writes them as one result file. `gannet campaign merge` joins "
          "result files of any number of machines and seeds.\n\nWithout EXPERIMENT it tells which "
          "there are. With --jobs it prints a command for each run of a campaign, for GNU "
          "parallel, a batch system or a shell.\n\nExperiments: " +
          names() + ".",
      .options = {{.name = "seed",
                   .kind = ArgumentKind::kInteger,
                   .value = "N",
                   .min = 0,
                   .preset = "1",
                   .help = "Of noise, random motion and search."},
                  {.name = "method",
                   .choices = {"ours", "papers", "both"},
                   .preset = "ours",
                   .help = "papers: rm_ga with the paper's fitness and 540 evaluations a frame, "
                           "without refinement, prediction and feed-forward. both: with --jobs."},
                  {.name = "output",
                   .letter = 'o',
                   .value = "FILE",
                   .help = "The result; its folder is made."},
                  {.name = "record",
                   .value = "DIR",
                   .help = "Also write the run for `gannet report`; not of single frames."},
                  {.name = "jobs",
                   .value = "DIR",
                   .help = "Run nothing: print a command for each run, results into DIR."},
                  {.name = "seeds",
                   .kind = ArgumentKind::kInteger,
                   .value = "N",
                   .min = 1,
                   .max = 100000,
                   .preset = "3",
                   .help = "With --jobs: seeds 1 to N."},
                  {.name = "gannetd",
                   .value = "PATH",
                   .help = "The daemon; the one beside this program if absent."},
                  {.name = "assets",
                   .value = "DIR",
                   .help = "The photographs; $GANNET_ASSETS or build/assets if absent."}},
      .positionals = {{.name = "experiment", .value = "EXPERIMENT", .help = "Its name."}},
      .example =
          "gannet-world paper p001_crab --seed 2 -o crab.2.json\n"
          "gannet-world paper --jobs results --seeds 100 --method both | parallel",
      .exit_codes = "0  done, whatever the figures are\n2  bad words\n3  the run broke off",
      .see_also = "gannet-world(1), gannet-campaign-merge(1), gannet-campaign-report(1)"};
}

int run_paper_command(const std::string& program, std::span<const std::string> args) {
  Arguments arguments;
  if (const auto code = begin_command(paper_command(), args, arguments)) return *code;
  const std::string name = arguments.text("experiment");
  const PaperExperiment* experiment = find_paper(name);
  if (experiment == nullptr && !name.empty())
    return fail(2, "there is no experiment '" + name + "'; there are: " + names());
  if (arguments.given("jobs")) {
    tell_jobs(program, arguments, experiment);
    return 0;
  }
  if (arguments.text("method") == "both") return fail(2, "--method both needs --jobs");
  if (experiment == nullptr) {
    tell_experiments();
    return 0;
  }
  return run_one(program, arguments, *experiment);
}

}  // namespace gannet::world
