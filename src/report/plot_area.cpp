#include "src/report/plot_area.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace gannet::report {

PlotArea::PlotArea(const PlotFrame& frame, const std::vector<std::string>& legend, Swatch swatch,
                   double left_margin, double right_margin)
    : canvas_(frame.width, frame.height, frame.title),
      left_(left_margin),
      right_(frame.width - right_margin),
      top_(legend.size() > 1 ? 56 : 36),
      bottom_(frame.height - 46) {
  canvas_.text(left_, 20, frame.title, "title", Anchor::kStart);
  if (legend.size() > 1) draw_legend(legend, swatch);
}

void PlotArea::draw_legend(const std::vector<std::string>& legend, Swatch swatch) {
  double x = left_;
  for (std::size_t i = 0; i < legend.size(); ++i) {
    const double width = swatch == Swatch::kLine ? 26 : 14;
    if (swatch == Swatch::kLine) {
      canvas_.line(x, 39, x + width, 39, series_line(static_cast<int>(i)));
    } else {
      canvas_.rectangle(x, 34, width, 9, series_fill(static_cast<int>(i)));
    }
    canvas_.text(x + width + 6, 43, legend[i], "text", Anchor::kStart);
    x += width + 6 + text_pixels(legend[i]) + 18;
  }
}

void PlotArea::draw_x(const PlotAxis& axis, bool grid) {
  for (const double tick : axis.ticks()) {
    const double x = axis.pixel(tick);
    if (grid) canvas_.line(x, top_, x, bottom_, "grid");
    canvas_.line(x, bottom_, x, bottom_ + 4, "axis");
    canvas_.text(x, bottom_ + 17, axis.label(tick), "text", Anchor::kMiddle);
  }
  canvas_.line(left_, bottom_, right_, bottom_, "axis");
}

void PlotArea::draw_y(const PlotAxis& axis) {
  for (const double tick : axis.ticks()) {
    const double y = axis.pixel(tick);
    canvas_.line(left_, y, right_, y, "grid");
    canvas_.text(left_ - 7, y + 4, axis.label(tick), "text", Anchor::kEnd);
  }
}

void PlotArea::draw_names(const Axis& x, const Axis& y) {
  canvas_.text((left_ + right_) / 2, bottom_ + 37, axis_title(x), "text", Anchor::kMiddle);
  canvas_.vertical_text(15, (top_ + bottom_) / 2, axis_title(y));
}

void PlotArea::draw_level_y(const PlotAxis& axis, const Level& level) {
  const double y = axis.pixel(level.value);
  if (y < top_ - 0.5 || y > bottom_ + 0.5) return;
  canvas_.line(left_, y, right_, y, "level");
  // Above its line, below where there is no room.
  canvas_.text(right_ - 3, y - 4 < top_ + 8 ? y + 13 : y - 4, level.name, "small halo",
               Anchor::kEnd);
}

// row: levels beside each other take turns in height, so that their names do not meet.
void PlotArea::draw_level_x(const PlotAxis& axis, const Level& level, int row) {
  const double x = axis.pixel(level.value);
  if (x < left_ - 0.5 || x > right_ + 0.5) return;
  canvas_.line(x, top_, x, bottom_, "level");
  const bool room = x + 5 + text_pixels(level.name) < right_;
  canvas_.text(room ? x + 4 : x - 4, top_ + 11 + 14 * row, level.name, "small halo",
               room ? Anchor::kStart : Anchor::kEnd);
}

std::string axis_title(const Axis& axis) {
  if (axis.unit.empty()) return axis.name;
  return axis.name + (axis.name.empty() ? "" : " ") + "(" + axis.unit + ")";
}

std::string scale_colour(double share) {
  struct Colour {
    double r, g, b;
  };
  constexpr std::array<Colour, 10> kScale = {{{0, 34, 78},
                                              {18, 53, 112},
                                              {59, 73, 108},
                                              {87, 93, 109},
                                              {112, 113, 115},
                                              {138, 134, 120},
                                              {165, 156, 116},
                                              {195, 179, 105},
                                              {225, 204, 85},
                                              {254, 232, 56}}};
  const double place = std::clamp(share, 0.0, 1.0) * (kScale.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(place), kScale.size() - 2);
  const double t = place - static_cast<double>(i);
  const auto mixed = [&](double a, double b) {
    return static_cast<unsigned>(a + t * (b - a) + 0.5);
  };
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", mixed(kScale[i].r, kScale[i + 1].r) & 255u,
                mixed(kScale[i].g, kScale[i + 1].g) & 255u,
                mixed(kScale[i].b, kScale[i + 1].b) & 255u);
  return text;
}

bool scale_is_dark(double share) { return share < 0.55; }

}  // namespace gannet::report
