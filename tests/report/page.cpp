#include "tests/report/page.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "platform/linux/whole_file.hpp"
#include "src/report/html_report.hpp"
#include "src/report/statistics.hpp"
#include "src/report/svg_plot.hpp"

namespace gannet::robustness {
namespace {

using report::number;
using Json = nlohmann::ordered_json;

struct Measure {
  const char* name;
  const char* unit;
  double high;  // of the colours
  double (*value)(const Score&);
};
constexpr Measure kMeasures[] = {
    {"right", "%", 100, [](const Score& s) { return 100.0 * s.right / s.trials; }},
    {"trusted though wrong", "%", 100,
     [](const Score& s) { return 100.0 * s.trusted_wrong / s.trials; }},
    {"error across", "mm", 4, [](const Score& s) { return s.side_mm; }},
    {"error in depth", "mm", 8, [](const Score& s) { return s.depth_mm; }},
    {"error of angle", "°", 5, [](const Score& s) { return s.angle_deg; }}};

std::string axis_text(const Axis& axis) {
  return axis.name + (*axis.unit != 0 ? std::string(" [") + axis.unit + "]" : "");
}

std::vector<std::string> names_of(const Axis& axis) {
  std::vector<std::string> out;
  for (const double step : axis.steps) out.push_back(step_text(step));
  return out;
}

std::string map_of(const Plane& plane, const std::vector<Cell>& cells, std::size_t method,
                   const Measure& measure) {
  report::PlotFrame frame;
  frame.title = std::string(kMethods[method].name) + ": " + measure.name;
  frame.x = {plane.x.name, plane.x.unit};
  frame.y = {plane.y.name, plane.y.unit};
  frame.width = 500;
  frame.height = 270;
  report::HeatMap map;
  map.columns = static_cast<int>(plane.x.steps.size());
  map.rows = static_cast<int>(plane.y.steps.size());
  map.column_names = names_of(plane.x);
  map.row_names = names_of(plane.y);
  map.value_name = measure.unit;
  map.value_range = report::Range{0, measure.high};
  map.print_values = true;
  for (const Cell& cell : cells) map.values.push_back(measure.value(score_of(cell.trials[method])));
  return report::heat_map(frame, map);
}

std::string share_text(const Score& score) {
  const auto [low, high] = report::wilson95(score.right, score.trials);
  return std::to_string(score.right) + " of " + std::to_string(score.trials) + " (" +
         number(100 * low, 0) + " … " + number(100 * high, 0) + " %)";
}

std::string error_text(const Score& s) {
  return number(s.side_mm, 1) + " / " + number(s.depth_mm, 1) + " / " + number(s.angle_deg, 1);
}

report::Table table_of(const Plane& plane, const std::vector<Cell>& cells) {
  std::vector<std::string> header = {axis_text(plane.x), axis_text(plane.y)};
  for (const Method& method : kMethods) {
    header.push_back(std::string(method.name) + " right");
    header.push_back("mm / mm / °");
    header.push_back("trusted wrong");
  }
  report::Table table(header);
  for (int c = 0; c < plane.cells(); ++c) {
    const Conditions at = plane.at(c);
    std::vector<std::string> row = {step_text(at.*plane.x.value), step_text(at.*plane.y.value)};
    for (const auto& trials : cells[static_cast<std::size_t>(c)].trials) {
      const Score score = score_of(trials);
      row.insert(row.end(),
                 {share_text(score), error_text(score), std::to_string(score.trusted_wrong)});
    }
    table.add(row);
  }
  return table;
}

std::string how(const Findings& f) {
  const Conditions usual;
  return "Each cell: " + std::to_string(f.contest.trials) +
         " single stereo pairs (640 × 480, rendered with optics, water, exposure and sensor "
         "noise), "
         "the target found from nothing with " +
         std::to_string(f.contest.evaluations) +
         " evaluations. Both methods see the same pairs and search the same volume (0.4 … 1 m, "
         "tilts to 40°, roll to 45°), and the pose that either finds is refined by Gannet's own "
         "refinement, which the papers do not have. Right: within 10 mm in x and in y, 20 mm in "
         "depth and 10°. Errors are medians of the right answers (grey: none was right). Trusted "
         "though wrong: the method's own measure called a wrong pose found. What a plane does not "
         "vary stays at " +
         step_text(usual.light_lux) + " lx, c = " + step_text(usual.turbidity_per_m) +
         " /m (of green; red and blue as in turbid water), nothing hidden, blur " +
         step_text(usual.blur_px) + " px, " + step_text(usual.distance_m) + " m, tilt " +
         step_text(usual.tilt_deg) + "°, " + step_text(usual.distractors) +
         " distractors. The occluded share is that of the target's box.";
}

Score all_of(const std::vector<Cell>& cells, std::size_t method) {
  std::vector<Outcome> all;
  for (const Cell& cell : cells)
    all.insert(all.end(), cell.trials[method].begin(), cell.trials[method].end());
  return score_of(all);
}

report::Table summary_table(const Findings& f) {
  std::vector<std::string> header = {"plane"};
  for (const Method& method : kMethods) {
    header.push_back(std::string(method.name) + " right (95 %)");
    header.push_back("median mm / mm / °");
    header.push_back("trusted wrong");
  }
  report::Table table(header);
  for (std::size_t p = 0; p < f.planes.size(); ++p) {
    std::vector<std::string> row = {std::string(f.planes[p].x.name) + " × " + f.planes[p].y.name};
    for (std::size_t m = 0; m < kMethods.size(); ++m) {
      const Score score = all_of(f.cells[p], m);
      row.insert(row.end(),
                 {share_text(score), error_text(score), std::to_string(score.trusted_wrong)});
    }
    table.add(row);
  }
  return table;
}

Json json_of(const Score& s) {
  const auto [low, high] = report::wilson95(s.right, s.trials);
  return {{"trials", s.trials},
          {"right", s.right},
          {"low95", low},
          {"high95", high},
          {"trusted_wrong", s.trusted_wrong},
          {"side_mm", s.side_mm},
          {"depth_mm", s.depth_mm},
          {"angle_deg", s.angle_deg}};
}

Json json_of(const Plane& plane, const std::vector<Cell>& cells) {
  Json out = Json::array();
  for (int c = 0; c < plane.cells(); ++c) {
    const Conditions at = plane.at(c);
    Json cell = {{plane.x.name, at.*plane.x.value}, {plane.y.name, at.*plane.y.value}};
    for (std::size_t m = 0; m < kMethods.size(); ++m)
      cell[kMethods[m].name] = json_of(score_of(cells[static_cast<std::size_t>(c)].trials[m]));
    out.push_back(cell);
  }
  return out;
}

}  // namespace

Result<void> write_page(const Findings& f, const std::string& path) {
  report::HtmlReport page("How robust is recognition?",
                          "One cold frame: Gannet's search and fitness beside the published ones");
  page.paragraph(how(f));
  page.table(summary_table(f), "All cells of a plane together; 95 % intervals (Wilson).");
  for (std::size_t p = 0; p < f.planes.size(); ++p) {
    const Plane& plane = f.planes[p];
    page.heading(std::string(plane.x.name) + " and " + plane.y.name);
    for (const Measure& measure : kMeasures) {
      page.begin_row();
      for (std::size_t m = 0; m < kMethods.size(); ++m)
        page.svg(map_of(plane, f.cells[p], m, measure));
      page.end_row();
    }
    page.table(table_of(plane, f.cells[p]),
               "Right with its 95 % interval; median errors across, in depth and of angle.");
  }
  page.heading("What was seen");
  for (const std::string& note : f.notes) page.paragraph(note);
  page.paragraph("Seed " + std::to_string(f.contest.seed) +
                 "; the same seed gives this page again.");
  return page.write(path);
}

Result<void> write_json(const Findings& f, const std::string& path) {
  Json out = {{"seed", f.contest.seed},
              {"trials", f.contest.trials},
              {"evaluations", f.contest.evaluations},
              {"pictures", f.notes}};
  for (std::size_t p = 0; p < f.planes.size(); ++p)
    out["planes"][f.planes[p].name] = json_of(f.planes[p], f.cells[p]);
  return linux_os::write_file(path, out.dump(1) + "\n");
}

std::string summary(const Findings& f) { return summary_table(f).text(); }

}  // namespace gannet::robustness
