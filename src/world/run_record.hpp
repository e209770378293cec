// RunRecord: what is left of a run: the table that people read, result.json, trace.csv and
// events.csv. Called at the end of a run, world thread.
#pragma once

#include <string>

#include "platform/base/result.hpp"
#include "src/world/simulation.hpp"

namespace gannet::world {

std::string result_table(const RunResult& result);
// What the daemon says of its own times and losses; live they are this machine's, stepped only
// frame → pose and the counts mean something.
std::string timing_table(const RunResult& result);
control::Json result_json(const Scenario& scenario, const RunResult& result, bool stepped);

// Into a folder that is made.
Result<void> write_record(const std::string& folder, const Scenario& scenario,
                          const RunResult& result, bool stepped);

}  // namespace gannet::world
