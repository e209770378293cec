// The plots of one run, as SVG text: how it came to the goal and held it, what recognition said,
// what the motors did, how long things took. Normal thread.
#pragma once

#include <string>

#include "src/tool/report_run.hpp"

namespace gannet::tool {

std::string error_plot(const ReportRun& run);       // the whole run
std::string held_error_plot(const ReportRun& run);  // once settled
std::string yaw_plot(const ReportRun& run);
std::string path_from_above(const ReportRun& run);   // x and z of Σ_H at the reference place
std::string path_from_behind(const ReportRun& run);  // x and y, y upwards
std::string estimate_plot(const ReportRun& run);     // recognised minus true position
std::string fitness_plot(const ReportRun& run);
std::string throttle_plot(const ReportRun& run);

// Empty: nothing was measured. name as in "daemon/latencies/NAME"; scale 1000: µs for ms.
std::string latency_plot(const ReportRun& run, const std::string& name, const std::string& title,
                         const std::string& unit = "ms", double scale = 1);

}  // namespace gannet::tool
