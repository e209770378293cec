// The figures of runs that a reader asks for first: settling, errors, fitness, times, jitter,
// drops; one column for each run. Normal thread.
#pragma once

#include <vector>

#include "src/report/table.hpp"
#include "src/tool/report_run.hpp"

namespace gannet::tool {

report::Table figures_table(const std::vector<ReportRun>& runs);
report::Table checks_table(const ReportRun& run);  // with verdicts where they decide: stepped
report::Table stages_table(const ReportRun& run);  // of the daemon's loops
report::Table counts_table(const std::vector<ReportRun>& runs);

// From where on the run counts as holding: settled, or its second half if it never was.
double held_from_s(const ReportRun& run);

// Samples of a recorded histogram (result.json, "daemon/latencies/NAME"), ms. It keeps buckets of
// 1/16 octave: their counts are spread evenly within them.
std::vector<double> latency_samples_ms(const ReportRun& run, const std::string& name);

}  // namespace gannet::tool
