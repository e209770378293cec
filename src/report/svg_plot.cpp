#include "src/report/svg_plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/report/plot_area.hpp"
#include "src/report/table.hpp"

namespace gannet::report {
namespace {

using Points = std::vector<std::pair<double, double>>;

class RangeFinder {
 public:
  void add(double v) {
    if (!std::isfinite(v)) return;
    range_.low = std::min(range_.low, v);
    range_.high = std::max(range_.high, v);
  }
  Range range() const { return range_.low <= range_.high ? range_ : Range{0, 1}; }

 private:
  Range range_{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
};

int ticks_for(double pixels, double each) { return std::max(static_cast<int>(pixels / each), 2); }

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& things) {
  std::vector<std::string> names;
  for (const auto& thing : things) names.push_back(thing.name);
  return names;
}

// Pieces without gaps. Where several samples share a pixel column, its first, least, greatest and
// last stand for them, so that no peak is lost.
std::vector<Points> line_pieces(const Series& s, const PlotAxis& x_axis, const PlotAxis& y_axis) {
  std::vector<Points> pieces(1);
  Points column;
  constexpr std::size_t kFewPoints = 2000;  // as many as are drawn one by one
  const bool thin = s.x.size() > kFewPoints;
  const auto flush = [&] {
    if (thin && column.size() > 4) {
      const auto by_y = [](const auto& a, const auto& b) { return a.second < b.second; };
      const auto [low, high] = std::minmax_element(column.begin(), column.end(), by_y);
      const auto [one, two] = std::minmax(low, high);
      pieces.back().insert(pieces.back().end(), {column.front(), *one, *two, column.back()});
    } else {
      pieces.back().insert(pieces.back().end(), column.begin(), column.end());
    }
    column.clear();
  };
  for (std::size_t i = 0; i < std::min(s.x.size(), s.y.size()); ++i) {
    if (!std::isfinite(s.x[i]) || !std::isfinite(s.y[i])) {
      flush();
      if (!pieces.back().empty()) pieces.emplace_back();
      continue;
    }
    const std::pair<double, double> point{x_axis.pixel(s.x[i]), y_axis.pixel(s.y[i])};
    if (!column.empty() && std::floor(column.back().first) != std::floor(point.first)) flush();
    column.push_back(point);
  }
  flush();
  return pieces;
}

void draw_series(PlotArea& area, const Series& s, int index, const PlotAxis& x_axis,
                 const PlotAxis& y_axis) {
  if (s.dots) {
    for (std::size_t i = 0; i < std::min(s.x.size(), s.y.size()); ++i) {
      if (!std::isfinite(s.x[i]) || !std::isfinite(s.y[i])) continue;
      area.canvas().dot(x_axis.pixel(s.x[i]), y_axis.pixel(s.y[i]), 2.2, series_fill(index));
    }
    return;
  }
  for (const Points& piece : line_pieces(s, x_axis, y_axis)) {
    if (piece.size() == 1) {
      area.canvas().dot(piece[0].first, piece[0].second, 1.5, series_fill(index));
    } else {
      area.canvas().polyline(piece, series_line(index));
    }
  }
}

// Widens the range that has too few units for its pixels.
void equalise(Range& x, double x_pixels, Range& y, double y_pixels) {
  constexpr double kMargin = 1.06;
  const double unit = kMargin * std::max((x.high - x.low) / x_pixels, (y.high - y.low) / y_pixels);
  const auto widen = [unit](Range& r, double pixels) {
    const double centre = (r.low + r.high) / 2;
    r = {centre - unit * pixels / 2, centre + unit * pixels / 2};
  };
  widen(x, x_pixels);
  widen(y, y_pixels);
}

}  // namespace

std::string line_plot(const PlotFrame& frame, const std::vector<Series>& series,
                      const std::vector<Level>& levels, bool equal_scale) {
  PlotArea area(frame, names_of(series), Swatch::kLine);
  RangeFinder xs;
  RangeFinder ys;
  for (const Series& s : series) {
    for (const double x : s.x) xs.add(x);
    for (const double y : s.y) ys.add(y);
  }
  for (const Level& level : levels) ys.add(level.value);
  Range x_range = frame.x.range.value_or(xs.range());
  Range y_range = frame.y.range.value_or(ys.range());
  const double width = area.right() - area.left();
  const double height = area.bottom() - area.top();
  if (equal_scale) equalise(x_range, width, y_range, height);
  const PlotAxis x_axis(x_range, area.left(), area.right(), ticks_for(width, 80), false);
  const PlotAxis y_axis(y_range, area.bottom(), area.top(), ticks_for(height, 42), !equal_scale);
  area.draw_y(y_axis);
  area.draw_x(x_axis, true);
  for (const Level& level : levels) area.draw_level_y(y_axis, level);
  // Two pixels of margin: lines along the border keep their width.
  area.canvas().begin_clip(area.left() - 2, area.top() - 2, width + 4, height + 4);
  for (std::size_t i = 0; i < series.size(); ++i) {
    draw_series(area, series[i], static_cast<int>(i), x_axis, y_axis);
  }
  area.canvas().end_clip();
  area.draw_names(frame.x, frame.y);
  return area.canvas().svg();
}

std::string histogram(const PlotFrame& frame, const std::vector<double>& values, int bins,
                      const std::vector<Level>& levels) {
  PlotArea area(frame, {}, Swatch::kArea);
  RangeFinder xs;
  for (const double v : values) xs.add(v);
  for (const Level& level : levels) xs.add(level.value);
  const PlotAxis x_axis(frame.x.range.value_or(xs.range()), area.left(), area.right(),
                        ticks_for(area.right() - area.left(), 80), true);
  // √n bins: enough to show a second hump, few enough that counts are not noise.
  if (bins <= 0) bins = static_cast<int>(std::sqrt(static_cast<double>(values.size())));
  bins = std::clamp(bins, 5, 120);
  std::vector<double> counts(static_cast<std::size_t>(bins));
  const Range range = x_axis.range();
  int outside = 0;
  for (const double v : values) {
    if (!(v >= range.low && v <= range.high)) {
      ++outside;
      continue;
    }
    const int bin = static_cast<int>((v - range.low) / (range.high - range.low) * bins);
    counts[static_cast<std::size_t>(std::min(bin, bins - 1))] += 1;
  }
  const double most = std::max(*std::max_element(counts.begin(), counts.end()), 1.0);
  const PlotAxis y_axis(frame.y.range.value_or(Range{0, most}), area.bottom(), area.top(),
                        ticks_for(area.bottom() - area.top(), 42), true);
  area.draw_y(y_axis);
  const double width = (area.right() - area.left()) / bins;
  for (int i = 0; i < bins; ++i) {
    const double count = counts[static_cast<std::size_t>(i)];
    const double y = std::max(y_axis.pixel(count), area.top());
    if (count == 0) continue;
    area.canvas().rectangle(area.left() + i * width + 0.5, y, std::max(width - 1, 0.5),
                            area.bottom() - y, series_fill(0));
  }
  area.draw_x(x_axis, false);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    area.draw_level_x(x_axis, levels[i], static_cast<int>(i % 3));
  }
  area.draw_names(frame.x, frame.y);
  std::string note = "n = " + std::to_string(values.size());
  if (outside > 0) note += ", " + std::to_string(outside) + " outside";
  area.canvas().text(area.right(), 20, note, "small", Anchor::kEnd);
  return area.canvas().svg();
}

std::string bar_chart(const PlotFrame& frame, const std::vector<std::string>& categories,
                      const std::vector<BarGroup>& groups, const std::vector<Level>& levels) {
  PlotArea area(frame, names_of(groups), Swatch::kArea);
  RangeFinder ys;
  ys.add(0);
  for (const BarGroup& g : groups) {
    for (const double v : g.values) ys.add(v);
    for (const Range& r : g.intervals) {
      ys.add(r.low);
      ys.add(r.high);
    }
  }
  for (const Level& level : levels) ys.add(level.value);
  const PlotAxis y_axis(frame.y.range.value_or(ys.range()), area.bottom(), area.top(),
                        ticks_for(area.bottom() - area.top(), 42), true);
  area.draw_y(y_axis);
  const double zero = y_axis.pixel(std::clamp(0.0, y_axis.range().low, y_axis.range().high));
  const double slot = (area.right() - area.left()) / std::max<double>(categories.size(), 1);
  const double bar = std::min(0.76 * slot / std::max<double>(groups.size(), 1), 46.0);
  for (std::size_t c = 0; c < categories.size(); ++c) {
    const double centre = area.left() + slot * (static_cast<double>(c) + 0.5);
    area.canvas().text(centre, area.bottom() + 17, categories[c], "text", Anchor::kMiddle);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if (c >= groups[g].values.size() || !std::isfinite(groups[g].values[c])) continue;
      const double x =
          centre + bar * (static_cast<double>(g) - 0.5 * static_cast<double>(groups.size()));
      const double y = std::clamp(y_axis.pixel(groups[g].values[c]), area.top(), area.bottom());
      area.canvas().rectangle(x + 1, std::min(y, zero), bar - 2, std::abs(zero - y),
                              series_fill(static_cast<int>(g)));
      if (c >= groups[g].intervals.size()) continue;
      const double low = y_axis.pixel(groups[g].intervals[c].low);
      const double high = y_axis.pixel(groups[g].intervals[c].high);
      area.canvas().line(x + bar / 2, low, x + bar / 2, high, "whisker");
      area.canvas().line(x + bar / 2 - 4, low, x + bar / 2 + 4, low, "whisker");
      area.canvas().line(x + bar / 2 - 4, high, x + bar / 2 + 4, high, "whisker");
    }
  }
  area.canvas().line(area.left(), zero, area.right(), zero, "axis");
  for (const Level& level : levels) area.draw_level_y(y_axis, level);
  area.draw_names(frame.x, frame.y);
  return area.canvas().svg();
}

namespace {

// The colour of a value in 64 steps, so that runs of one colour become one rectangle.
std::string cell_colour(double value, Range values) {
  if (!std::isfinite(value)) return "";
  const double share =
      values.high > values.low ? (value - values.low) / (values.high - values.low) : 0.5;
  return scale_colour(std::round(std::clamp(share, 0.0, 1.0) * 63) / 63);
}

void draw_cells(PlotArea& area, const HeatMap& map, Range values) {
  const double width = (area.right() - area.left()) / map.columns;
  const double height = (area.bottom() - area.top()) / map.rows;
  // Half a pixel of overlap: no seams where a cell ends between pixels. Not beyond the last.
  const auto size = [](double from, double to, double end) {
    return std::min(to + 0.5, end) - from;
  };
  for (int row = 0; row < map.rows; ++row) {
    const double y = area.top() + row * height;
    const double* cells = map.values.data() + static_cast<std::ptrdiff_t>(row) * map.columns;
    for (int begin = 0, end = 0; begin < map.columns; begin = end) {
      const std::string colour = cell_colour(cells[begin], values);
      for (end = begin + 1; end < map.columns && cell_colour(cells[end], values) == colour;) ++end;
      const double x = area.left() + begin * width;
      const double w = size(x, area.left() + end * width, area.right());
      const double h = size(y, y + height, area.bottom());
      if (colour.empty()) {
        area.canvas().rectangle(x, y, w, h, "missing");
      } else {
        area.canvas().filled(x, y, w, h, colour);
      }
    }
  }
}

void print_cells(PlotArea& area, const HeatMap& map, Range values) {
  const double width = (area.right() - area.left()) / map.columns;
  const double height = (area.bottom() - area.top()) / map.rows;
  const double span = values.high - values.low;
  const int decimals = span < 3 ? 2 : span < 30 ? 1 : 0;
  for (std::size_t i = 0; i < map.values.size(); ++i) {
    if (!std::isfinite(map.values[i])) continue;
    const std::size_t columns = static_cast<std::size_t>(map.columns);
    const double x = area.left() + (static_cast<double>(i % columns) + 0.5) * width;
    const double y = area.top() + (static_cast<double>(i / columns) + 0.5) * height;
    const bool dark = scale_is_dark(span > 0 ? (map.values[i] - values.low) / span : 0.5);
    area.canvas().text(x, y + 4, number(map.values[i], decimals), dark ? "on-dark" : "on-light",
                       Anchor::kMiddle);
  }
}

void draw_scale(PlotArea& area, const HeatMap& map, Range values) {
  const PlotAxis axis(values, area.bottom(), area.top(), ticks_for(area.bottom() - area.top(), 42),
                      false);
  const double x = area.right() + 18;
  constexpr int kSteps = 64;
  const double height = (area.bottom() - area.top()) / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    area.canvas().filled(x, area.bottom() - (i + 1) * height, 14, height + 0.5,
                         scale_colour((i + 0.5) / kSteps));
  }
  for (const double tick : axis.ticks()) {
    area.canvas().text(x + 19, axis.pixel(tick) + 4, axis.label(tick), "text", Anchor::kStart);
  }
  area.canvas().text(x + 14, area.top() - 8, map.value_name, "small", Anchor::kMiddle);
}

// Range of the cells' borders where centres are given.
Range with_borders(Range centres, int cells) {
  const double half = cells > 1 ? (centres.high - centres.low) / (cells - 1) / 2 : 0.5;
  return {centres.low - half, centres.high + half};
}

}  // namespace

std::string heat_map(const PlotFrame& frame, const HeatMap& map) {
  double left = 64;
  for (const std::string& name : map.row_names) left = std::max(left, 34 + text_pixels(name));
  PlotArea area(frame, {}, Swatch::kArea, left, 84);
  if (map.columns < 1 || map.rows < 1 ||
      map.values.size() != static_cast<std::size_t>(map.columns * map.rows)) {
    return area.canvas().svg();
  }
  RangeFinder finder;
  for (const double v : map.values) finder.add(v);
  const Range values = map.value_range.value_or(finder.range());
  draw_cells(area, map, values);
  if (map.print_values) print_cells(area, map, values);
  const double width = (area.right() - area.left()) / map.columns;
  const double height = (area.bottom() - area.top()) / map.rows;
  if (map.column_names.empty()) {
    area.draw_x(PlotAxis(with_borders(map.x, map.columns), area.left(), area.right(),
                         ticks_for(area.right() - area.left(), 80), false),
                false);
  }
  for (std::size_t i = 0; i < map.column_names.size(); ++i) {
    area.canvas().text(area.left() + (static_cast<double>(i) + 0.5) * width, area.bottom() + 17,
                       map.column_names[i], "text", Anchor::kMiddle);
  }
  if (map.row_names.empty()) {
    const bool downwards = map.y.low <= map.y.high;
    const Range range = with_borders(downwards ? map.y : Range{map.y.high, map.y.low}, map.rows);
    const PlotAxis axis(range, downwards ? area.top() : area.bottom(),
                        downwards ? area.bottom() : area.top(),
                        ticks_for(area.bottom() - area.top(), 42), false);
    for (const double tick : axis.ticks()) {
      area.canvas().text(area.left() - 7, axis.pixel(tick) + 4, axis.label(tick), "text",
                         Anchor::kEnd);
    }
  }
  for (std::size_t i = 0; i < map.row_names.size(); ++i) {
    area.canvas().text(area.left() - 7, area.top() + (static_cast<double>(i) + 0.5) * height + 4,
                       map.row_names[i], "text", Anchor::kEnd);
  }
  draw_scale(area, map, values);
  area.draw_names(frame.x, frame.y);
  return area.canvas().svg();
}

}  // namespace gannet::report
