// PlotArea: the frame that all plots share: title, legend, axes with ticks and names, levels.
// The inner part of svg_plot. Any thread; a value.
#pragma once

#include <string>
#include <vector>

#include "src/report/svg_canvas.hpp"
#include "src/report/svg_plot.hpp"

namespace gannet::report {

enum class Swatch { kLine, kArea };

class PlotArea {
 public:
  // legend: names of the series, by their colours; none is drawn for less than two.
  PlotArea(const PlotFrame& frame, const std::vector<std::string>& legend, Swatch swatch,
           double left_margin = 64, double right_margin = 20);

  SvgCanvas& canvas() { return canvas_; }
  double left() const { return left_; }
  double right() const { return right_; }
  double top() const { return top_; }
  double bottom() const { return bottom_; }

  void draw_x(const PlotAxis& axis, bool grid);
  void draw_y(const PlotAxis& axis);
  void draw_names(const Axis& x, const Axis& y);
  void draw_level_y(const PlotAxis& axis, const Level& level);
  void draw_level_x(const PlotAxis& axis, const Level& level, int row);

 private:
  void draw_legend(const std::vector<std::string>& legend, Swatch swatch);

  SvgCanvas canvas_;
  double left_, right_, top_, bottom_;
};

std::string axis_title(const Axis& axis);  // "depth error (mm)"

// The colour of a share 0 … 1 on the blue–grey–yellow scale cividis (Nuñez, Anderton & Renslow,
// PLoS ONE 13, 2018), which colour-blind readers see alike; "#rrggbb".
std::string scale_colour(double share);
bool scale_is_dark(double share);  // words on it must be light

}  // namespace gannet::report
