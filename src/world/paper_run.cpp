#include "src/world/paper_run.hpp"

#include <cmath>

#include "src/world/check.hpp"
#include "src/world/paper_frames.hpp"
#include "src/world/path_measures.hpp"
#include "src/world/run_record.hpp"

namespace gannet::world {
namespace {

using control::Json;

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json bounds_json(const Bounds& bounds) {
  return {number_or_null(bounds.least), number_or_null(bounds.most)};
}

double measured(const char* name, const Trace& trace, const Window& window) {
  for (const Measure& measure : measures())
    if (std::string_view(name) == measure.name) return measure.value(trace, window);
  return std::nan("");
}

bool is_sweep(const Scenario& scenario) {
  return !scenario.targets.empty() && scenario.targets.front().motion.kind == "multisine";
}

void add_bode(const Trace& trace, const Window& window, PaperResult& result) {
  static const char* const kAxes[] = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    const Bode response = bode(trace, window, axis);
    result.curves.push_back({"gain", kAxes[axis], "Hz", "", response.frequency_hz, response.gain});
    result.curves.push_back(
        {"phase", kAxes[axis], "Hz", "°", response.frequency_hz, response.phase_deg});
  }
}

Result<Scenario> scenario_of(const PaperRequest& request) {
  auto scenario = load_scenario(find_scenario(request.experiment->scenario, request.program));
  if (!scenario) return scenario;
  scenario->seed = request.seed;
  if (request.experiment->duration_s > 0) scenario->duration_s = request.experiment->duration_s;
  scenario->daemon.settings.push_back("track.seed=" + std::to_string(request.seed));
  for (std::string& setting : method_settings(*request.experiment, request.method))
    scenario->daemon.settings.push_back(std::move(setting));
  return scenario;
}

Result<PaperResult> run_scenario(const PaperRequest& request, const Scenario& scenario,
                                 const PaperTick& tick) {
  auto simulation = Simulation::create(scenario, request.options);
  if (!simulation) return simulation.error();
  constexpr double kThousandths = 1000;
  const auto run = (*simulation)->run([&](const TraceRow& row) {
    tick(std::lround(row.time_s * kThousandths), std::lround(scenario.duration_s * kThousandths));
  });
  if (!run) return run.error();
  if (!request.record.empty()) {
    const auto written = write_record(request.record, scenario, *run, true);
    if (!written) return written.error();
  }
  const Window window = {.from_s = request.experiment->from_s};
  PaperResult result;
  for (const PaperFigure& figure : request.experiment->figures)
    result.values.push_back({&figure, measured(figure.measure, run->trace, window)});
  if (is_sweep(scenario)) add_bode(run->trace, window, result);
  result.trials = frames_heard(run->trace, window);
  result.notes = run->notes;
  result.host_s = run->host_s;
  return result;
}

}  // namespace

Result<PaperResult> run_paper(const PaperRequest& request, const PaperTick& tick) {
  const auto scenario = scenario_of(request);
  if (!scenario) return scenario.error();
  if (request.experiment->run == PaperRun::kFrames) return run_frames(request, *scenario, tick);
  return run_scenario(request, *scenario, tick);
}

Json paper_json(const PaperRequest& request, const PaperResult& result) {
  const PaperExperiment& experiment = *request.experiment;
  Json json;
  json["format"] = 1;
  json["experiment"] = experiment.name;
  json["paper"] = experiment.paper;
  json["what"] = experiment.what;
  json["method"] = kPaperMethods[static_cast<std::size_t>(request.method)];
  json["seed"] = request.seed;
  json["trials"] = result.trials;
  json["host_s"] = result.host_s;
  json["version"] = GANNET_VERSION;
  json["notes"] = result.notes;
  json["figures"] = Json::array();
  for (const PaperValue& value : result.values)
    json["figures"].push_back({{"name", value.figure->name},
                               {"unit", value.figure->unit},
                               {"theirs", value.figure->theirs},
                               {"value", number_or_null(value.value)},
                               {"allowed", bounds_json(value.figure->allowed)},
                               {"goal", bounds_json(value.figure->goal)}});
  json["curves"] = Json::array();
  for (const PaperCurve& curve : result.curves)
    json["curves"].push_back({{"plot", curve.plot},
                              {"name", curve.name},
                              {"x_unit", curve.x_unit},
                              {"y_unit", curve.y_unit},
                              {"x", curve.x},
                              {"y", curve.y}});
  return json;
}

}  // namespace gannet::world
