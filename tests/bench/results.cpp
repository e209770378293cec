#include "tests/bench/results.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "platform/linux/cpu.hpp"

namespace gannet::bench {
namespace {

using Json = nlohmann::ordered_json;

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

Json json_of(const Spread& s) { return {{"median", s.median}, {"low", s.low}, {"high", s.high}}; }

Json json_of(const Goal& g) {
  return {{"is", g.text}, {"measured", g.measured}, {"reached", g.reached}};
}

Goal goal_of(const char* words, double limit, const std::string& what, double measured,
             bool reached) {
  char number[40];
  std::snprintf(number, sizeof number, "%s %.5g ", words, limit);
  return {number + what, measured, reached};
}

Json json_of(const Row& row) {
  Json ratios = Json::array();
  for (const Ratio& r : row.ratios) ratios.push_back({{"is", r.text}, {"value", json_of(r.value)}});
  Json json = {{"name", row.name}, {"ratios", ratios},     {"value", json_of(row.value)},
               {"unit", row.unit}, {"trials", row.trials}, {"note", row.note}};
  for (const Goal& g : row.goals) json["goals"].push_back(json_of(g));
  return json;
}

}  // namespace

Goal at_most(double limit, const std::string& what, double measured) {
  return goal_of("at most", limit, what, measured, measured <= limit);
}

Goal at_least(double limit, const std::string& what, double measured) {
  return goal_of("at least", limit, what, measured, measured >= limit);
}

Machine this_machine(const std::string& flags, const std::string& commit) {
#if defined(__clang__)
  const std::string compiler = "clang " __clang_version__;
#else
  const std::string compiler = "g++ " __VERSION__;
#endif
  return {cpu_model(), linux_os::core_count(), compiler, flags, commit};
}

Results::Results(const Machine& machine) : machine_(machine) {
  std::printf("%s, %d cores; %s\n", machine.cpu.c_str(), machine.cores, machine.compiler.c_str());
  if (!machine.flags.empty()) std::printf("flags: %s\n", machine.flags.c_str());
  if (!machine.commit.empty()) std::printf("commit: %s\n", machine.commit.c_str());
  std::printf(
      "Medians; in brackets the quartiles. Contenders take turns; ratios are taken within a turn.\n"
      "CPU time of the thread, unless a group says otherwise.\n");
}

void Results::group(const std::string& name, const std::string& how) {
  groups_.push_back({name, how, {}});
  std::printf("\n== %s\n   %s\n", name.c_str(), how.c_str());
}

void Results::add(const Row& row) {
  groups_.back().rows.push_back(row);
  std::printf("%-34s", row.name.c_str());
  for (const Ratio& r : row.ratios) {
    std::printf("  %.2f [%.2f, %.2f] %s;", r.value.median, r.value.low, r.value.high,
                r.text.c_str());
  }
  std::printf("  %.4g [%.4g, %.4g] %s, %d trials%s%s", row.value.median, row.value.low,
              row.value.high, row.unit.c_str(), row.trials, row.note.empty() ? "" : "; ",
              row.note.c_str());
  for (const Goal& g : row.goals)
    std::printf("; goal %s: %s", g.text.c_str(), g.reached ? "reached" : "MISSED");
  std::printf("\n");
  std::fflush(stdout);
}

void Results::tell_goals() const {
  std::printf("\n== goals\n");
  for (const Group& group : groups_)
    for (const Row& row : group.rows)
      for (const Goal& g : row.goals)
        std::printf("%-8s %-38s goal %s; measured %.4g, %d trials\n",
                    g.reached ? "reached" : "MISSED", row.name.c_str(), g.text.c_str(), g.measured,
                    row.trials);
}

bool Results::write_json(const std::string& path) const {
  Json groups = Json::array();
  for (const Group& g : groups_) {
    Json rows = Json::array();
    for (const Row& row : g.rows) rows.push_back(json_of(row));
    groups.push_back({{"name", g.name}, {"how", g.how}, {"rows", rows}});
  }
  const Json all = {{"format", 1},
                    {"machine",
                     {{"cpu", machine_.cpu},
                      {"cores", machine_.cores},
                      {"compiler", machine_.compiler},
                      {"flags", machine_.flags},
                      {"commit", machine_.commit}}},
                    {"groups", groups}};
  std::ofstream out(path);
  out << all.dump(1) << '\n';
  return static_cast<bool>(out.flush());
}

Spread wilson_percent(int successes, int trials) {
  constexpr double kZ = 1.959964;
  const double n = trials;
  const double p = successes / n;
  const double middle = (p + kZ * kZ / (2 * n)) / (1 + kZ * kZ / n);
  const double half = kZ / (1 + kZ * kZ / n) * std::sqrt(p * (1 - p) / n + kZ * kZ / (4 * n * n));
  return {100 * p, 100 * std::max(0.0, middle - half), 100 * std::min(1.0, middle + half)};
}

}  // namespace gannet::bench
