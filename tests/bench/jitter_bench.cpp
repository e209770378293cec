// The servo loop's wake-ups and the way from frame to CAN of the real gannetd in its simulated
// world, beside cyclictest at the same period and priority, turn about, idle and under load.
#include <sched.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "platform/linux/cpu.hpp"
#include "tests/bench/benches.hpp"

namespace gannet::bench {
namespace {

using Json = nlohmann::json;

constexpr int kPeriodUs = 1000;
constexpr int kPriority = 80;  // gannetd's own default for the servo loop
constexpr int kLongestUs = 20'000;

// Wake-ups by whole microseconds of lateness, rounded up, as cyclictest counts them.
struct Histogram {
  std::vector<double> counts = std::vector<double>(kLongestUs + 1, 0.0);
  double total = 0;

  void add(double us, double count) {
    counts[static_cast<std::size_t>(std::clamp(us, 0.0, double{kLongestUs}))] += count;
    total += count;
  }
  void add(const Histogram& other) {
    for (std::size_t i = 0; i < counts.size(); ++i) counts[i] += other.counts[i];
    total += other.total;
  }
  double quantile_us(double share) const {
    double below = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      below += counts[i];
      if (below >= share * total) return static_cast<double>(i);
    }
    return kLongestUs;
  }
};

bool has_real_time_rights() {
  const pid_t child = fork();
  if (child == 0) {
    const sched_param priority{.sched_priority = kPriority};
    _exit(sched_setscheduler(0, SCHED_FIFO, &priority) == 0 ? 0 : 1);
  }
  int status = 1;
  waitpid(child, &status, 0);
  return status == 0;
}

Histogram cyclictest(int seconds) {
  Histogram histogram;
  std::array<char, 160> command{};
  std::snprintf(command.data(), command.size(), "cyclictest -q -m -p%d -i%d -l%d -h%d 2>/dev/null",
                kPriority, kPeriodUs, seconds * 1'000'000 / kPeriodUs, kLongestUs);
  std::FILE* output = popen(command.data(), "r");
  std::array<char, 160> line{};
  while (output != nullptr && std::fgets(line.data(), line.size(), output) != nullptr) {
    int us = 0;
    double count = 0;
    if (std::sscanf(line.data(), "%d %lf", &us, &count) == 2) histogram.add(us, count);
  }
  if (output != nullptr) pclose(output);
  return histogram;
}

// What the daemon itself counted, live.
struct DaemonRun {
  Histogram jitter;
  double frame_to_pose_us = 0, frame_to_can_us = 0;  // medians
};

DaemonRun daemon(int seconds, const std::string& folder) {
  const char* build = std::getenv("GANNET_BUILD");
  const std::string world =
      std::string(build != nullptr ? build : "build/release") + "/bin/gannet-world";
  const std::string command =
      world + " rov_still --live --duration-s " + std::to_string(seconds) +
      " --set realtime.servo_rate_hz=" + std::to_string(1'000'000 / kPeriodUs) + " --record " +
      folder + " >/dev/null 2>&1";
  DaemonRun run;
  [[maybe_unused]] const int verdict =
      std::system(command.c_str());  // the scenario's is another matter
  std::ifstream file(folder + "/result.json");
  const Json result = Json::parse(file, nullptr, false);
  if (result.is_discarded()) return run;
  const Json& latencies = result.at("daemon").at("latencies");
  for (const Json& bucket : latencies.at("servo_jitter").at("buckets"))
    run.jitter.add(std::ceil(bucket[0].get<double>()), bucket[1].get<double>());
  run.frame_to_pose_us = latencies.at("frame_to_pose").value("p50_us", 0.0);
  run.frame_to_can_us = latencies.at("frame_to_can").value("p50_us", 0.0);
  return run;
}

// Loops at normal priority, one a core, as long as it lives.
class Load {
 public:
  explicit Load(bool wanted) {
    for (int i = 0; wanted && i < linux_os::core_count(); ++i) {
      const pid_t child = fork();
      if (child == 0) {
        const std::atomic<bool> over{false};
        while (!over.load(std::memory_order_relaxed)) {
        }
      }
      children_.push_back(child);
    }
  }
  ~Load() {
    for (const pid_t child : children_) kill(child, SIGKILL);
    for (const pid_t child : children_) waitpid(child, nullptr, 0);
  }
  Load(const Load&) = delete;
  Load& operator=(const Load&) = delete;

 private:
  std::vector<pid_t> children_;
};

void compare(bool loaded, int turns, int seconds, const std::string& folder, Results& results) {
  const Load load(loaded);
  const std::string when = loaded ? "under load" : "idle";
  Histogram ours, theirs;
  std::vector<double> ratios, after_pose_us;
  for (int turn = 0; turn < turns; ++turn) {
    const Histogram reference = cyclictest(seconds);
    const DaemonRun run = daemon(seconds, folder);
    if (reference.total == 0 || run.jitter.total == 0) continue;
    theirs.add(reference);
    ours.add(run.jitter);
    ratios.push_back(run.jitter.quantile_us(0.9999) / std::max(1.0, reference.quantile_us(0.9999)));
    after_pose_us.push_back(run.frame_to_can_us - run.frame_to_pose_us);
  }
  if (ratios.empty()) {
    std::printf("%s: no figures; cyclictest (rt-tests) or gannet-world is missing\n", when.c_str());
    return;
  }
  const auto tell = [&](const std::string& who, const Histogram& h, std::vector<Ratio> of) {
    std::array<char, 160> note{};
    std::snprintf(note.data(), note.size(), "p50 %.0f, p99 %.0f, longest %.0f us",
                  h.quantile_us(0.5), h.quantile_us(0.99), h.quantile_us(1));
    const double worst = h.quantile_us(0.9999);
    results.add({who + " p99.99, " + when,
                 "us",
                 {worst, worst, worst},
                 static_cast<int>(h.total),
                 std::move(of),
                 note.data()});
  };
  tell("cyclictest", theirs, {});
  tell("servo wake-up", ours, {{"times cyclictest's", spread_of(ratios)}});
  results.add({"pose to CAN, " + when,
               "us",
               spread_of(after_pose_us),
               static_cast<int>(after_pose_us.size()),
               {},
               "goal: at most a period (" + std::to_string(kPeriodUs) + ") and 100 us"});
}

}  // namespace

void bench_jitter(const Options& options, Results& results) {
  results.group(
      "jitter",
      "Lateness of wake-ups every millisecond at FIFO 80: gannetd's servo loop in a live run, "
      "and cyclictest, turn about; wall time. Goal: 1.1 times cyclictest's at p99.99. Pose to "
      "CAN: median of frame to CAN less that of frame to pose.");
  if (options.quick) {
    std::printf("left out of a quick run\n");
    return;
  }
  if (!has_real_time_rights()) {
    std::printf("left out: no right to real-time priorities here\n");
    return;
  }
  const std::string folder =
      (std::filesystem::temp_directory_path() / ("gannet-jitter-" + std::to_string(getpid())))
          .string();
  constexpr int kTurns = 3;
  constexpr int kSeconds = 4;
  for (const bool loaded : {false, true}) compare(loaded, kTurns, kSeconds, folder, results);
  std::error_code error;
  std::filesystem::remove_all(folder, error);
}

}  // namespace gannet::bench
