#include "src/world/run_record.hpp"

#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "platform/linux/whole_file.hpp"
#include "src/report/table.hpp"
#include "src/world/reactions.hpp"

namespace gannet::world {

std::string result_table(const RunResult& result) {
  report::Table table({"check", "found", "verdict"});
  for (const Verdict& verdict : result.verdicts)
    table.add({verdict.text, verdict.found, verdict.passed ? "passed" : "FAILED"});
  return table.text();
}

std::string timing_table(const RunResult& result) {
  using control::Json;
  const Json latencies = result.top.value("latencies", Json::object());
  report::Table table({"time, ms", "count", "p50", "p90", "p99", "max"});
  for (const auto& [name, histogram] : latencies.items()) {
    std::vector<std::string> row = {name, std::to_string(histogram.value("count", 0))};
    for (const char* key : {"p50_us", "p90_us", "p99_us", "max_us"})
      row.push_back(report::number(histogram.value(key, 0.0) / 1000, 3));
    table.add(std::move(row));
  }
  std::string text = table.text();
  const Json drops = result.top.value("drops", Json::object());
  text += "lost: " + std::to_string(result.cameras.lost) + " pairs by the simulated cameras";
  for (const auto& [name, count] : drops.items())
    if (name != "frames" && name != "can_sent" && name != "can_received" && count != 0)
      text += ", " + count.dump() + " " + name;
  return text + "\n";
}

namespace {

control::Json reactions_json(const Trace& trace) {
  const auto known = [](double ms) {
    return std::isfinite(ms) ? control::Json(ms) : control::Json();
  };
  control::Json json = control::Json::array();
  for (const Reaction& r : reactions_of(trace))
    json.push_back({{"event", r.event},
                    {"at_s", r.time_s},
                    {"still_ms", known(r.still_ms)},
                    {"turning_ms", known(r.turning_ms)},
                    {"state", r.state},
                    {"state_ms", known(r.state_ms)}});
  return json;
}

}  // namespace

control::Json result_json(const Scenario& scenario, const RunResult& result, bool stepped) {
  control::Json json;
  json["format"] = 1;
  json["scenario"] = scenario.name;
  json["description"] = scenario.description;
  json["clock"] = stepped ? "stepped" : "live";
  json["seed"] = scenario.seed;
  json["duration_s"] = scenario.duration_s;
  json["passed"] = result.passed();
  json["checks"] = control::Json::array();
  for (const Verdict& verdict : result.verdicts)
    json["checks"].push_back(
        {{"check", verdict.text}, {"found", verdict.found}, {"passed", verdict.passed}});
  for (const Measure& measure : measures()) {
    const double value = measure.value(result.trace, {});
    json["measures"][measure.name] = std::isfinite(value) ? control::Json(value) : control::Json();
  }
  json["reactions"] = reactions_json(result.trace);
  json["cameras"] = {{"frames", result.cameras.frames},
                     {"withheld", result.cameras.withheld},
                     {"lost", result.cameras.lost}};
  json["notes"] = result.notes;
  json["host_s"] = result.host_s;
  json["daemon"] = result.top;
  return json;
}

Result<void> write_record(const std::string& folder, const Scenario& scenario,
                          const RunResult& result, bool stepped) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return Error{folder + ": " + error.message()};
  const std::pair<const char*, std::string> files[] = {
      {"result.json", result_json(scenario, result, stepped).dump(2) + "\n"},
      {"trace.csv", trace_csv(result.trace)},
      {"events.csv", events_csv(result.trace)}};
  for (const auto& [name, text] : files) {
    const auto written = linux_os::write_file(folder + "/" + name, text);
    if (!written) return written;
  }
  return {};
}

}  // namespace gannet::world
