// The report as a page: what was done, figures, plots and pictures of each run, and of a real pair.
// Normal thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "src/report/html_report.hpp"
#include "src/tool/report_run.hpp"
#include "src/tool/report_stereo.hpp"

namespace gannet::tool {

struct ReportContent {
  std::vector<ReportRun> runs;  // at least one
  std::optional<ReportStereo> stereo;
};

// Error: a kept frame or a model cannot be read.
Result<report::HtmlReport> report_page(const ReportContent& content);

// Whether all that decides passed: checks of stepped runs (live ones hang on the machine's load)
// and depths of the pair.
bool passed(const ReportContent& content);

}  // namespace gannet::tool
