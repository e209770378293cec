// What gannetd takes of a vehicle's computer: memory, share of a core, time until it is ready. The
// real daemon in a live world, with motors, a person who watches, and two 640x480 cameras.
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <thread>

#include "src/control/client.hpp"
#include "src/world/assets.hpp"
#include "src/world/daemon_process.hpp"
#include "src/world/simulation.hpp"
#include "tests/bench/benches.hpp"

namespace gannet::bench {
namespace {

using control::Json;
using std::chrono::milliseconds;

constexpr double kRateHz = 30;

// Of a process: resident megabytes, and seconds of CPU by the names of its threads.
double resident_mb(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/status");
  double kb = 0;
  for (std::string line; std::getline(file, line);)
    if (line.rfind("VmRSS:", 0) == 0) kb = std::atof(line.c_str() + 6);
  return kb * 1024 / 1e6;
}

std::map<std::string, double> cpu_seconds(pid_t pid) {
  std::map<std::string, double> spent;
  std::error_code error;
  for (const auto& task :
       std::filesystem::directory_iterator("/proc/" + std::to_string(pid) + "/task", error)) {
    std::ifstream name_file(task.path() / "comm"), time_file(task.path() / "schedstat");
    std::string name;
    double ns = 0;
    if (std::getline(name_file, name) && time_file >> ns) spent[name] += ns * 1e-9;
  }
  return spent;
}

// A person who talks to the daemon; connects anew when needed.
class Asker {
 public:
  explicit Asker(std::string socket) : socket_(std::move(socket)) {}
  // Null: no answer.
  Json ask(const char* method) {
    auto client = control::Client::connect(socket_);
    if (!client) return {};
    auto answer = client->call(method);
    return answer ? std::move(*answer) : Json();
  }
  // False: not within the time.
  bool until(const std::function<bool(const Json& status)>& is_so, Duration longest) {
    const double end = wall_ns() + static_cast<double>(longest.count());
    while (wall_ns() < end) {
      const Json status = ask("status");
      if (status.is_object() && is_so(status)) return true;
      std::this_thread::sleep_for(milliseconds(1));
    }
    return false;
  }

 private:
  std::string socket_;
};

struct Footprint {
  std::vector<double> resident_mb, share_percent, share_at_30_percent, rate_hz, start_ms;
  std::string problem;
};

// One window of a locked daemon.
bool watch(pid_t pid, Asker& asker, Duration window, Footprint& found) {
  const auto locked = [](const Json& s) { return s["estimate"].value("state", "") == "locked"; };
  const auto frames = [](const Json& top) { return top["drops"].value("frames", 0.0); };
  if (!asker.until(locked, std::chrono::seconds(10))) return false;
  const Json before = asker.ask("top");
  const double begin = wall_ns();
  const auto cpu_before = cpu_seconds(pid);
  std::this_thread::sleep_for(window);
  const auto cpu_after = cpu_seconds(pid);
  const double seconds = (wall_ns() - begin) * 1e-9;
  const Json after = asker.ask("top");
  if (!before.is_object() || !after.is_object() || !asker.until(locked, milliseconds(50)))
    return false;
  const double rate = (frames(after) - frames(before)) / seconds;
  if (rate <= 0) return false;
  double images = 0, rest = 0;
  for (const auto& [name, spent] : cpu_after) {
    const auto earlier = cpu_before.find(name);
    const double own = spent - (earlier == cpu_before.end() ? 0 : earlier->second);
    (name == "gannet-vision" || name == "gannet-capture" ? images : rest) += own / seconds;
  }
  found.rate_hz.push_back(rate);
  found.share_percent.push_back(100 * (images + rest));
  found.share_at_30_percent.push_back(100 * (images * kRateHz / rate + rest));
  found.resident_mb.push_back(resident_mb(pid));
  return true;
}

// Beside the world, which runs on: locked windows, then one start after the other.
void observe(const std::string& gannetd, const world::RunFiles& files, int windows, int starts,
             Footprint& found) {
  Asker asker(files.control());
  for (int i = 0; i <= starts; ++i) {
    const double begin = wall_ns();
    auto daemon = world::DaemonProcess::start(gannetd, {"-c", files.config()}, files.log());
    if (!daemon) {
      found.problem = daemon.error().text;
      return;
    }
    const bool is_up = asker.until([](const Json& s) { return s.value("state", "") != "starting"; },
                                   std::chrono::seconds(5));
    // The first one waits for the world, which begins when it meets it.
    if (i > 0 && is_up) found.start_ms.push_back((wall_ns() - begin) * 1e-6);
    for (int w = 0; i == 0 && w < windows; ++w)
      if (!watch(daemon->pid(), asker, std::chrono::seconds(2), found))
        found.problem = "not locked all the time";
    daemon->stop(std::chrono::seconds(2));
  }
}

void add_rows(const Footprint& found, Results& results) {
  const auto add = [&](const char* name, const char* unit, const std::vector<double>& values,
                       double limit, const std::string& note) {
    const Spread spread = spread_of(values);
    results.add({name,
                 unit,
                 spread,
                 static_cast<int>(values.size()),
                 {},
                 note,
                 {at_most(limit, unit, spread.median)}});
  };
  if (found.resident_mb.empty() || found.start_ms.empty()) {
    std::printf("no figures\n");
    return;
  }
  char note[160];
  std::snprintf(note, sizeof note,
                "%.2f %% at the %.1f pairs a second that this machine could draw; capture and "
                "vision are counted as for 30",
                spread_of(found.share_percent).median, spread_of(found.rate_hz).median);
  add("resident, locked", "MB", found.resident_mb, 40, "");
  add("share of a core, locked, at 30 Hz", "%", found.share_at_30_percent, 10, note);
  add("start to standby", "ms", found.start_ms, 200, "asked every millisecond");
}

}  // namespace

void bench_footprint(const Options& options, Results& results) {
  results.group("footprint",
                "gannetd in a live world, locked: 640x480 twice at 30 Hz, eight motors at 200 Hz, "
                "a person who looks on, memory locked where this user may. Windows of 2 s; CPU "
                "time of all its threads. Then it is started anew beside the running world.");
  const char* build = std::getenv("GANNET_BUILD");
  const std::string bin = std::string(build != nullptr ? build : "build/release") + "/bin/";
  auto scenario = world::load_scenario(world::find_scenario("rov_still", bin + "gannet-world"));
  if (options.quick || !scenario || !std::filesystem::exists(bin + "gannetd")) {
    std::printf("left out: %s\n", options.quick ? "a quick run" : "no gannetd or no scenario");
    return;
  }
  constexpr int kWindows = 5, kStarts = 10;
  scenario->duration_s = 22;
  scenario->camera.fps = kRateHz;
  world::SimulationOptions how;
  how.stepped = false;
  how.assets = world::assets_folder();
  how.folder =
      (std::filesystem::temp_directory_path() / ("gannet-footprint-" + std::to_string(getpid())))
          .string();
  auto world = world::Simulation::create(*scenario, how);
  if (!world) {
    std::printf("left out: %s\n", world.error().text.c_str());
    return;
  }
  Footprint found;
  std::thread observer(
      [&] { observe(bin + "gannetd", (*world)->files(), kWindows, kStarts, found); });
  const auto run = (*world)->run([](const world::TraceRow&) {});
  observer.join();
  if (!run) found.problem = run.error().text;
  if (!found.problem.empty()) std::printf("%s\n", found.problem.c_str());
  add_rows(found, results);
  std::error_code error;
  std::filesystem::remove_all(how.folder, error);
}

}  // namespace gannet::bench
