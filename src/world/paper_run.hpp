// PaperRun: one experiment of the papers with one method and one seed, run to its figures and
// written as one result file, which `gannet campaign` joins with others. World's thread alone.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "platform/base/result.hpp"
#include "src/control/json.hpp"
#include "src/world/paper_table.hpp"
#include "src/world/simulation.hpp"

namespace gannet::world {

struct PaperValue {
  const PaperFigure* figure;
  double value;  // NaN: it could not be said
};

// A line of a plot of the report: "gain" over "Hz".
struct PaperCurve {
  std::string plot;
  std::string name;
  std::string x_unit, y_unit;
  std::vector<double> x, y;
};

struct PaperResult {
  std::vector<PaperValue> values;
  std::vector<PaperCurve> curves;
  int trials = 0;  // frames that the figures are made of
  std::vector<std::string> notes;
  double host_s = 0;
};

struct PaperRequest {
  const PaperExperiment* experiment;
  PaperMethod method = PaperMethod::kOurs;
  int seed = 1;
  std::string program;        // argv[0], to find scenarios
  SimulationOptions options;  // gannetd, assets
  std::string record;         // folder for the run's record; "": none
};

// tick(done, total): thousandths of seconds, or frames.
using PaperTick = std::function<void(long done, long total)>;
Result<PaperResult> run_paper(const PaperRequest& request, const PaperTick& tick);

control::Json paper_json(const PaperRequest& request, const PaperResult& result);

}  // namespace gannet::world
