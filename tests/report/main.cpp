// The robustness report: `make report`.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string_view>
#include <thread>

#include "platform/linux/clock.hpp"
#include "platform/linux/worker_pool.hpp"
#include "src/report/progress.hpp"
#include "src/world/assets.hpp"
#include "tests/report/false_locks.hpp"
#include "tests/report/page.hpp"

namespace {

using namespace gannet;
using namespace gannet::robustness;

constexpr const char* kHelp =
    "run [--out FOLDER] [--trials N] [--evaluations N] [--seed N] [--only PLANE]\n    "
    "    [--workers N]\n"
    "  --out          where report.html and results.json go, build/report unless told\n"
    "  --trials       pairs a cell, 15 unless told\n"
    "  --evaluations  of each search, 20000 unless told\n"
    "  --only         water | clutter | pose | blur\n"
    "  --false-locks  seconds of footage (30 Hz, rendered) of other creatures without the target, "
    "in\n"
    "                 place of the heat maps: how often the tracker locks on something; and a "
    "third\n"
    "                 as much with the target: how often it is locked on it\n"
    "  --workers      threads; all cores unless told. The result does not depend on it.\n";

struct Options {
  Contest contest;
  std::string out = "build/report";
  std::string only;
  int false_locks_s = 0;  // 0: heat maps
  int workers = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
};

bool number_of(const char* text, int& to) {
  char* end = nullptr;
  const long value = std::strtol(text, &end, 10);
  if (*end != 0 || value < 1 || value > 1'000'000) return false;
  to = static_cast<int>(value);
  return true;
}

bool read(int argc, char** argv, Options& options) {
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view word = argv[i];
    const char* value = argv[i + 1];
    int seed = 0;
    if (word == "--out") {
      options.out = value;
    } else if (word == "--only") {
      options.only = value;
    } else if (word == "--seed" && number_of(value, seed)) {
      options.contest.seed = static_cast<std::uint64_t>(seed);
    } else if (!((word == "--trials" && number_of(value, options.contest.trials)) ||
                 (word == "--evaluations" && number_of(value, options.contest.evaluations)) ||
                 (word == "--false-locks" && number_of(value, options.false_locks_s)) ||
                 (word == "--workers" && number_of(value, options.workers)))) {
      return false;
    }
  }
  return argc % 2 == 1;
}

std::vector<Plane> chosen(const std::string& only) {
  std::vector<Plane> out;
  for (const Plane& plane : planes())
    if (only.empty() || only == plane.name) out.push_back(plane);
  return out;
}

struct Means {
  Cast cast;
  std::unique_ptr<linux_os::WorkerPool> pool;
};
Result<Means> prepare(const Options& options) {
  std::error_code error;
  std::filesystem::create_directories(options.out + "/models", error);
  if (error) return Error{options.out + ": " + error.message()};
  auto cast = make_cast(world::assets_folder(), options.out + "/models");
  if (!cast) return cast.error();
  const std::vector<linux_os::ThreadConfig> helpers(static_cast<std::size_t>(options.workers - 1));
  auto pool = linux_os::WorkerPool::create("report", helpers);
  if (!pool) return pool.error();
  return Means{std::move(*cast), std::move(*pool)};
}

report::Progress progress_of(const char* what, long total) {
  return {std::cerr, report::is_terminal(STDERR_FILENO), what, total, linux_os::monotonic_now()};
}

Result<Findings> measure(const Options& options, Means& means) {
  Findings findings = {options.contest, means.cast.notes, chosen(options.only), {}};
  long total = 0;
  for (const Plane& plane : findings.planes) total += plane.cells() * options.contest.trials;
  report::Progress progress = progress_of("scenes", total);
  auto cells = run(options.contest, means.cast, findings.planes, *means.pool,
                   [&](long done) { progress.update(done, linux_os::monotonic_now()); });
  if (!cells) return cells.error();
  progress.finish(linux_os::monotonic_now());
  findings.cells = std::move(*cells);
  return findings;
}

int failed(const Error& error) {
  std::fprintf(stderr, "%s\n", error.text.c_str());
  return 1;
}

int heat_maps(const Options& options, Means& means) {
  const auto findings = measure(options, means);
  if (!findings) return failed(findings.error());
  const std::string page = options.out + "/report.html", json = options.out + "/results.json";
  if (const auto written = write_page(*findings, page); !written) return failed(written.error());
  if (const auto written = write_json(*findings, json); !written) return failed(written.error());
  std::printf("%s\nwritten to %s and %s\n", summary(*findings).c_str(), page.c_str(), json.c_str());
  return 0;
}

int false_locks(const Options& options, Means& means) {
  const int clips = std::max(1, options.false_locks_s * 30 / kClipFrames);
  const Campaign campaign = {clips, (clips + 2) / 3, options.contest.seed};
  report::Progress progress = progress_of("clips", campaign.clips + campaign.clips_with);
  const auto count = count_locks(campaign, means.cast, *means.pool, [&](long done) {
    progress.update(done, linux_os::monotonic_now());
  });
  if (!count) return failed(count.error());
  progress.finish(linux_os::monotonic_now());
  std::printf("%s", lock_summary(*count).c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!read(argc, argv, options) || chosen(options.only).empty()) {
    std::fputs(kHelp, stderr);
    return 2;
  }
  auto means = prepare(options);
  if (!means) return failed(means.error());
  return options.false_locks_s > 0 ? false_locks(options, *means) : heat_maps(options, *means);
}
