#include "src/tool/report_figures.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "platform/base/stage_timer.hpp"
#include "src/report/statistics.hpp"

namespace gannet::tool {
namespace {

using control::Json;
using report::number;

// Values from a time on.
std::vector<double> since(const ReportRun& run, const std::vector<double>& values, double from_s) {
  std::vector<double> kept;
  for (std::size_t i = 0; i < std::min(values.size(), run.time_s.size()); ++i)
    if (run.time_s[i] >= from_s) kept.push_back(values[i]);
  return kept;
}

double held_rms(const ReportRun& run, const std::vector<double>& values) {
  return report::rms(since(run, values, held_from_s(run)));
}

double distance_mm(const ReportRun& run, std::size_t row) {
  return std::hypot(run.error_mm[0][row], run.error_mm[1][row], run.error_mm[2][row]);
}

double held_worst_mm(const ReportRun& run) {
  double worst = 0;
  for (std::size_t i = 0; i < run.time_s.size(); ++i)
    if (run.time_s[i] >= held_from_s(run)) worst = std::max(worst, distance_mm(run, i));
  return worst;
}

std::vector<double> found_values(const ReportRun& run, double (*of)(const ReportFrame&)) {
  std::vector<double> values;
  for (const ReportFrame& frame : run.frames)
    if (frame.found) values.push_back(of(frame));
  return values;
}

template <int Axis>
double estimate_error_mm(const ReportFrame& frame) {
  return 1000 * (frame.estimate.translation - frame.truth.translation)[Axis];
}

// Of the frames from the first found one on: before it the target was not chosen.
double found_percent(const ReportRun& run) {
  const auto is_found = [](const ReportFrame& f) { return f.found; };
  const auto first = std::find_if(run.frames.begin(), run.frames.end(), is_found);
  const auto count = std::count_if(first, run.frames.end(), is_found);
  return 100.0 * static_cast<double>(count) / static_cast<double>(run.frames.end() - first);
}

std::string percentiles(const ReportRun& run, const std::string& name, double scale, int decimals) {
  std::string text;
  for (const char* key : {"p50_us", "p90_us", "p99_us", "max_us"})
    text += (text.empty() ? "" : " / ") +
            number(number_at(run.result, "daemon/latencies/" + name + "/" + key) * scale, decimals);
  return text;
}

std::string three(double x, double y, double z, int decimals) {
  return number(x, decimals) + " / " + number(y, decimals) + " / " + number(z, decimals);
}

std::string count_at(const Json& json, std::string_view path) {
  return number(number_at(json, path), 0);
}

// Pairs that nobody recognised the target in, by where they were lost.
std::string drops(const ReportRun& run) {
  const Json& r = run.result;
  const double camera = number_at(r, "daemon/drops/camera_dropped") +
                        number_at(r, "daemon/drops/camera_lost") +
                        number_at(r, "daemon/drops/camera_broken");
  const double vision =
      number_at(r, "daemon/drops/vision_not_taken") + number_at(r, "daemon/drops/vision_skipped");
  return count_at(r, "cameras/lost") + " / " + number(camera, 0) + " / " + number(vision, 0);
}

// The first column's name, then a column for each run.
std::vector<std::string> header_of(const std::vector<ReportRun>& runs, const char* first) {
  std::vector<std::string> header = {first};
  for (const ReportRun& run : runs)
    header.push_back((run.stepped ? "stepped, " : "live, ") +
                     number(number_at(run.result, "duration_s"), 0) + " s");
  return header;
}

double servo_cycles(const ReportRun& run) {
  const Json* loops = member_at(run.result, "daemon/loops");
  if (loops == nullptr || !loops->is_array()) return std::nan("");
  for (const Json& loop : *loops)
    if (const Json* name = member_at(loop, "name"); name != nullptr && *name == "servo")
      return number_at(loop, "cycles");
  return std::nan("");
}

struct Row {
  const char* name;
  std::function<std::string(const ReportRun&)> cell;
};

std::vector<Row> figure_rows() {
  using Run = const ReportRun&;
  return {
      {"start: distance and yaw from the goal, mm / °",
       [](Run r) {
         return number(distance_mm(r, 0), 0) + " / " + number(std::abs(r.yaw_deg.front()), 1);
       }},
      {"settling time: from arming to within 20 mm and 3° for good, s",
       [](Run r) { return number(number_at(r.result, "measures/settle_s"), 2); }},
      {"RMS error while held, x / y / z, mm",
       [](Run r) {
         return three(held_rms(r, r.error_mm[0]), held_rms(r, r.error_mm[1]),
                      held_rms(r, r.error_mm[2]), 1);
       }},
      {"RMS error while held, yaw, °", [](Run r) { return number(held_rms(r, r.yaw_deg), 2); }},
      {"largest distance from the goal while held, mm",
       [](Run r) { return number(held_worst_mm(r), 1); }},
      {"recognition minus truth, RMS x / y / z, mm",
       [](Run r) {
         return three(report::rms(found_values(r, estimate_error_mm<0>)),
                      report::rms(found_values(r, estimate_error_mm<1>)),
                      report::rms(found_values(r, estimate_error_mm<2>)), 2);
       }},
      {"fitness, mean and least",
       [](Run r) {
         const auto f = found_values(r, [](const ReportFrame& frame) { return frame.fitness; });
         return number(report::mean(f), 3) + " / " + number(report::percentile(f, 0), 3);
       }},
      {"frames with the target found, since the first, %",
       [](Run r) { return number(found_percent(r), 1); }},
      {"frame → pose, p50 / p90 / p99 / max, ms",
       [](Run r) { return percentiles(r, "frame_to_pose", 1e-3, 1); }},
      {"frame → CAN, p50 / p90 / p99 / max, ms",
       [](Run r) { return percentiles(r, "frame_to_can", 1e-3, 1); }},
      {"middle of exposure → CAN, p50 / p90 / p99 / max, ms",
       [](Run r) { return percentiles(r, "exposure_to_can", 1e-3, 1); }},
      {"servo jitter (woken late), p50 / p90 / p99 / max, µs",
       [](Run r) {
         return r.stepped ? std::string("no clock") : percentiles(r, "servo_jitter", 1, 0);
       }},
      {"servo cycles / overruns",
       [](Run r) {
         return number(servo_cycles(r), 0) + " / " +
                count_at(r.result, "daemon/drops/servo_overruns");
       }},
      {"pairs given by the cameras", [](Run r) { return count_at(r.result, "cameras/frames"); }},
      {"pairs lost: not drawn in time by the simulator / by capture / by vision", drops},
      {"searches ended early by a newer pair",
       [](Run r) { return count_at(r.result, "daemon/drops/vision_preempted"); }},
      {"CAN frames sent / refused",
       [](Run r) {
         return count_at(r.result, "daemon/drops/can_sent") + " / " +
                count_at(r.result, "daemon/drops/can_send_refused");
       }},
  };
}

}  // namespace

double held_from_s(const ReportRun& run) {
  const double settled = run.settled_s();
  return std::isfinite(settled) ? settled : 0.5 * (run.time_s.front() + run.time_s.back());
}

report::Table figures_table(const std::vector<ReportRun>& runs) {
  report::Table table(header_of(runs, "figure"));
  for (const Row& row : figure_rows()) {
    std::vector<std::string> cells = {row.name};
    for (const ReportRun& run : runs) cells.push_back(row.cell(run));
    table.add(std::move(cells));
  }
  return table;
}

report::Table checks_table(const ReportRun& run) {
  std::vector<std::string> header = {"check", "measured"};
  if (run.stepped) header.push_back("verdict");  // a surplus cell is dropped
  report::Table table(header);
  const Json* checks = member_at(run.result, "checks");
  if (checks == nullptr || !checks->is_array()) return table;
  const auto word = [](const Json& check, const char* key) {
    const Json* text = member_at(check, key);
    return text != nullptr && text->is_string() ? text->get<std::string>() : std::string("–");
  };
  for (const Json& check : *checks) {
    const Json* passed = member_at(check, "passed");
    table.add({word(check, "check"), word(check, "found"),
               passed != nullptr && *passed == true ? "pass" : "fail"});
  }
  return table;
}

report::Table stages_table(const ReportRun& run) {
  report::Table table({"loop", "stage", "p50, ms", "p99, ms", "max, ms"});
  const Json* loops = member_at(run.result, "daemon/loops");
  if (loops == nullptr || !loops->is_array()) return table;
  const auto name_of = [](const Json& json) {
    const Json* name = member_at(json, "name");
    return name != nullptr && name->is_string() ? name->get<std::string>() : std::string("–");
  };
  for (const Json& loop : *loops) {
    const Json* stages = member_at(loop, "stages");
    if (stages == nullptr || !stages->is_array()) continue;
    for (const Json& stage : *stages) {
      const auto ms = [&](const char* key) { return number(number_at(stage, key) / 1000, 3); };
      table.add({name_of(loop), name_of(stage), ms("p50_us"), ms("p99_us"), ms("max_us")});
    }
  }
  return table;
}

report::Table counts_table(const std::vector<ReportRun>& runs) {
  report::Table table(header_of(runs, "count"));
  const Json* names = member_at(runs.front().result, "daemon/drops");
  if (names == nullptr || !names->is_object()) return table;
  for (const auto& [name, count] : names->items()) {
    std::vector<std::string> cells = {name};
    for (const ReportRun& run : runs) cells.push_back(count_at(run.result, "daemon/drops/" + name));
    table.add(std::move(cells));
  }
  return table;
}

std::vector<double> latency_samples_ms(const ReportRun& run, const std::string& name) {
  std::vector<double> samples;
  const Json* buckets = member_at(run.result, "daemon/latencies/" + name + "/buckets");
  if (buckets == nullptr || !buckets->is_array()) return samples;
  constexpr std::size_t kMostSamples = 10'000'000;
  for (const Json& bucket : *buckets) {
    if (!bucket.is_array() || bucket.size() != 2 || !bucket[0].is_number() ||
        !bucket[1].is_number_unsigned())
      continue;
    const double upper_ms = bucket[0].get<double>() / 1000;
    const auto upper_ns = static_cast<std::int64_t>(std::clamp(upper_ms * 1e6, 1.0, 7e10));
    const int index = LogHistogram::bucket_of(upper_ns - 1);
    const double lower_ms =
        index == 0 ? 0 : static_cast<double>(LogHistogram::upper_edge(index - 1)) * 1e-6;
    const auto count = std::min(bucket[1].get<std::size_t>(), kMostSamples - samples.size());
    for (std::size_t i = 0; i < count; ++i)
      samples.push_back(lower_ms + (upper_ms - lower_ms) * (static_cast<double>(i) + 0.5) /
                                       static_cast<double>(count));
  }
  return samples;
}

}  // namespace gannet::tool
