#include "src/world/run_record.hpp"

#include <cmath>
#include <filesystem>

#include "platform/linux/whole_file.hpp"
#include "src/report/table.hpp"

namespace gannet::world {

std::string result_table(const RunResult& result) {
  report::Table table({"check", "found", "verdict"});
  for (const Verdict& verdict : result.verdicts)
    table.add({verdict.text, verdict.found, verdict.passed ? "passed" : "FAILED"});
  return table.text();
}

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
