// Plots as SVG text: lines over time (or any x), histograms, bars and heat maps. Values are in the
// unit that the axis names. Values that are not finite are left out (a gap in a line, a grey cell).
// Readable on light and dark ground and by colour-blind readers (svg_canvas.hpp). Any thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "src/report/plot_axis.hpp"

namespace gannet::report {

struct Axis {
  std::string name;
  std::string unit = "";                      // "mm"; empty: no unit
  std::optional<Range> range = std::nullopt;  // else what the values need
};

struct PlotFrame {
  std::string title;
  Axis x;
  Axis y;
  int width = 720;  // pixels
  int height = 300;
};

struct Series {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;  // as many as x
  bool dots = false;      // separate points, no line
};

// A value worth a dashed line: a limit, a goal, a percentile.
struct Level {
  std::string name;
  double value = 0;
};

// levels are values of y. Long series are thinned to what pixels show; peaks stay.
// equal_scale: one unit is as long along x as along y (paths seen from above).
std::string line_plot(const PlotFrame& frame, const std::vector<Series>& series,
                      const std::vector<Level>& levels = {}, bool equal_scale = false);

// Counts of values in equal bins over the x range; levels are values of x. bins 0: by the size of
// the sample. Values outside a given range are counted in a note.
std::string histogram(const PlotFrame& frame, const std::vector<double>& values, int bins = 0,
                      const std::vector<Level>& levels = {});

struct BarGroup {
  std::string name;                   // "gannet", "rm_ga": one colour
  std::vector<double> values;         // one for each category
  std::vector<Range> intervals = {};  // whiskers; empty or one for each category
};
std::string bar_chart(const PlotFrame& frame, const std::vector<std::string>& categories,
                      const std::vector<BarGroup>& groups, const std::vector<Level>& levels = {});

struct HeatMap {
  int columns = 0;
  int rows = 0;
  std::vector<double> values;  // row by row, the first row at the top
  Range x;                     // of the columns' centres, first to last
  Range y;                     // of the rows' centres, top to bottom; low > high is allowed
  std::string value_name;
  std::optional<Range> value_range = std::nullopt;
  bool print_values = false;  // in the cells, for few and large ones
  // Names instead of numbers, one for each column or row.
  std::vector<std::string> column_names = {};
  std::vector<std::string> row_names = {};
};
std::string heat_map(const PlotFrame& frame, const HeatMap& map);

}  // namespace gannet::report
