#include "src/tool/report_plots.hpp"

#include <algorithm>
#include <cmath>

#include "src/report/statistics.hpp"
#include "src/report/svg_plot.hpp"
#include "src/report/table.hpp"
#include "src/tool/report_figures.hpp"

namespace gannet::tool {
namespace {

using report::Axis;
using report::line_plot;
using report::PlotFrame;
using report::Range;
using report::Series;

constexpr int kWidth = 560;  // pixels; two beside each other
constexpr int kHeight = 290;

Axis time_axis() { return {.name = "time", .unit = "s"}; }

PlotFrame frame(const std::string& title, const Axis& x, const Axis& y) {
  return {.title = title, .x = x, .y = y, .width = kWidth, .height = kHeight};
}

std::vector<Series> empty_axes() {
  std::vector<Series> axes(3);
  axes[0].name = "x right";
  axes[1].name = "y down";
  axes[2].name = "z forward";
  return axes;
}

std::vector<Series> error_series(const ReportRun& run, double from_s) {
  std::vector<Series> series = empty_axes();
  for (std::size_t k = 0; k < run.time_s.size(); ++k) {
    if (run.time_s[k] < from_s) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      series[axis].x.push_back(run.time_s[k]);
      series[axis].y.push_back(run.error_mm[axis][k]);
    }
  }
  return series;
}

std::vector<double> negated(std::vector<double> values) {
  for (double& v : values) v = -v;
  return values;
}

std::string path_plot(const std::string& title, const Axis& x, const Axis& y, const Axes3& target,
                      const Axes3& held, std::size_t up, bool turn) {
  const auto of = [&](const Axes3& path) { return turn ? negated(path[up]) : path[up]; };
  PlotFrame f = frame(title, x, y);
  f.height = 420;
  return line_plot(f,
                   {{.name = "target", .x = target[0], .y = of(target)},
                    {.name = "point that the ROV holds on it", .x = held[0], .y = of(held)}},
                   {}, true);
}

}  // namespace

std::string error_plot(const ReportRun& run) {
  return line_plot(
      frame("Position error: target − goal in Σ_H", time_axis(), {.name = "error", .unit = "mm"}),
      error_series(run, run.time_s.front()));
}

std::string held_error_plot(const ReportRun& run) {
  return line_plot(frame("The same while held", time_axis(), {.name = "error", .unit = "mm"}),
                   error_series(run, held_from_s(run)));
}

std::string yaw_plot(const ReportRun& run) {
  return line_plot(frame("Yaw error", time_axis(), {.name = "error", .unit = "°"}),
                   {{.name = "yaw", .x = run.time_s, .y = run.yaw_deg}});
}

std::string path_from_above(const ReportRun& run) {
  return path_plot("Paths seen from above", {.name = "x right", .unit = "mm"},
                   {.name = "z forward", .unit = "mm"}, run.target_mm, run.held_mm, 2, false);
}

std::string path_from_behind(const ReportRun& run) {
  return path_plot("Paths as the ROV sees them", {.name = "x right", .unit = "mm"},
                   {.name = "up (−y)", .unit = "mm"}, run.target_mm, run.held_mm, 1, true);
}

std::string estimate_plot(const ReportRun& run) {
  std::vector<Series> series = empty_axes();
  for (const ReportFrame& f : run.frames) {
    if (!f.found) continue;
    const Eigen::Vector3d error = 1000 * (f.estimate.translation - f.truth.translation);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      series[axis].x.push_back(f.capture_s);
      series[axis].y.push_back(error[static_cast<Eigen::Index>(axis)]);
      series[axis].dots = true;
    }
  }
  return line_plot(frame("Recognition: found − true position, before the filter", time_axis(),
                         {.name = "error in the left camera", .unit = "mm"}),
                   series);
}

std::string fitness_plot(const ReportRun& run) {
  Series fitness;
  fitness.name = "fitness";
  for (const ReportFrame& f : run.frames) {
    if (!f.found) continue;
    fitness.x.push_back(f.capture_s);
    fitness.y.push_back(f.fitness);
  }
  return line_plot(frame("Fitness of the recognised pose", time_axis(),
                         {.name = "fitness", .range = Range{0, 1}}),
                   {fitness});
}

std::string throttle_plot(const ReportRun& run) {
  std::vector<Series> series;
  for (std::size_t i = 0; i < run.throttle.size(); ++i)
    series.push_back({.name = std::to_string(i + 1), .x = run.time_s, .y = run.throttle[i]});
  return line_plot(
      frame("Throttle that each thruster obeyed", time_axis(), {.name = "share of full thrust"}),
      series);
}

std::string latency_plot(const ReportRun& run, const std::string& name, const std::string& title,
                         const std::string& unit, double scale) {
  std::vector<double> values = latency_samples_ms(run, name);
  if (values.empty()) return "";
  for (double& v : values) v *= scale;
  const auto recorded = [&](const char* key) {  // as in the tables
    return number_at(run.result, "daemon/latencies/" + name + "/" + key) / 1000 * scale;
  };
  const double p50 = recorded("p50_us");
  const double p99 = recorded("p99_us");
  // Up to a little beyond p99: rare ones would squeeze the rest; they are counted in the note.
  const double low = report::percentile(values, 0) > 0.5 * p50 ? 0.8 * p50 : 0;
  const double high = std::max(1.15 * p99, 1.2 * p50);
  const int decimals = p50 < 10 ? 2 : 1;
  return report::histogram(frame(title, {.name = "time", .unit = unit, .range = Range{low, high}},
                                 {.name = "how often"}),
                           values, 60,
                           {{.name = "p50 " + report::number(p50, decimals), .value = p50},
                            {.name = "p99 " + report::number(p99, decimals), .value = p99}});
}

}  // namespace gannet::tool
