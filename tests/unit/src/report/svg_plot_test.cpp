#include "src/report/svg_plot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <sstream>

#include "src/report/plot_area.hpp"
#include "src/report/svg_canvas.hpp"

namespace gannet::report {
namespace {

int count(const std::string& text, const std::string& part) {
  int n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

// Every element is closed, in order, and no number is missing: what a browser would trip over.
void expect_well_formed(const std::string& svg) {
  std::vector<std::string> open;
  for (std::size_t at = svg.find('<'); at != std::string::npos; at = svg.find('<', at + 1)) {
    const std::size_t end = svg.find('>', at);
    ASSERT_NE(end, std::string::npos);
    const std::string element = svg.substr(at + 1, end - at - 1);
    ASSERT_EQ(element.find('<'), std::string::npos) << element;
    ASSERT_EQ(count(element, "\"") % 2, 0) << element;
    if (element[0] == '/') {
      ASSERT_FALSE(open.empty());
      ASSERT_EQ(open.back(), element.substr(1));
      open.pop_back();
    } else if (element.back() != '/') {
      open.push_back(element.substr(0, element.find(' ')));
    }
  }
  EXPECT_TRUE(open.empty());
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_EQ(svg.find("\"–\""), std::string::npos) << "a coordinate that is not finite";
}

// The numbers of the first line that is drawn: x, y, x, y …
std::vector<double> first_line(const std::string& svg) {
  const std::size_t begin = svg.find("points=\"") + 8;
  std::string list = svg.substr(begin, svg.find('"', begin) - begin);
  std::replace(list.begin(), list.end(), ',', ' ');
  std::istringstream in(list);
  return {std::istream_iterator<double>(in), {}};
}

const PlotFrame kFrame{"Error <x & \"y\">", {"time", "s"}, {"error", "mm"}};

TEST(LinePlot, draws_each_series_its_legend_and_the_units) {
  const std::string svg = line_plot(
      kFrame, {{"a", {0, 1, 2}, {0, 5, 3}}, {"b", {0, 1, 2}, {1, 1, 1}}}, {{"allowed", 4}});
  expect_well_formed(svg);
  EXPECT_EQ(count(svg, "<polyline"), 2);
  EXPECT_EQ(count(svg, ">a</text>") + count(svg, ">b</text>"), 2);
  EXPECT_EQ(count(svg, "time (s)"), 1);
  EXPECT_EQ(count(svg, "error (mm)"), 1);
  EXPECT_EQ(count(svg, ">allowed</text>"), 1);
  EXPECT_EQ(count(svg, "prefers-color-scheme:dark"), 1);
}

TEST(LinePlot, the_highest_point_is_drawn_highest) {
  const std::string svg = line_plot(kFrame, {{"a", {0, 1, 2}, {0, 10, 5}}});
  const std::vector<double> m = first_line(svg);
  ASSERT_EQ(m.size(), 6u);
  EXPECT_LT(m[3], m[5]);
  EXPECT_LT(m[5], m[1]);
  EXPECT_NEAR((m[1] + m[3]) / 2, m[5], 0.2);
  EXPECT_NEAR((m[0] + m[4]) / 2, m[2], 0.2);
}

TEST(LinePlot, leaves_a_gap_where_a_value_is_missing) {
  const std::string svg =
      line_plot(kFrame, {{"a", {0, 1, 2, 3, 4, 5}, {0, 1, NAN, 3, 4, INFINITY}}});
  expect_well_formed(svg);
  EXPECT_EQ(count(svg, "<polyline"), 2);
}

TEST(LinePlot, thins_long_series_but_keeps_their_peaks) {
  Series series{"a", {}, {}};
  for (int i = 0; i < 200000; ++i) {
    series.x.push_back(i);
    series.y.push_back(i == 77777 ? 100 : std::sin(i * 0.1));
  }
  PlotFrame frame = kFrame;
  frame.y.range = Range{-100, 100};
  const std::string svg = line_plot(frame, {series});
  EXPECT_LT(svg.size(), 80000u);
  // The peak touches the upper end of the axis.
  EXPECT_NE(svg.find(",36.0 "), std::string::npos);
}

TEST(LinePlot, equal_scale_makes_a_circle_round) {
  Series circle{"path", {}, {}};
  for (int i = 0; i < 100; ++i) {
    circle.x.push_back(std::cos(i * 0.0635));
    circle.y.push_back(std::sin(i * 0.0635));
  }
  const std::string svg = line_plot(kFrame, {circle}, {}, true);
  double x_low = 1e9, x_high = -1e9, y_low = 1e9, y_high = -1e9;
  const std::vector<double> line = first_line(svg);
  for (std::size_t i = 0; i < line.size(); i += 2) {
    x_low = std::min(x_low, line[i]);
    x_high = std::max(x_high, line[i]);
    y_low = std::min(y_low, line[i + 1]);
    y_high = std::max(y_high, line[i + 1]);
  }
  EXPECT_NEAR(x_high - x_low, y_high - y_low, 1);
  EXPECT_GT(y_high - y_low, 150);
}

TEST(LinePlot, nothing_to_draw_is_an_empty_frame) {
  expect_well_formed(line_plot(kFrame, {}));
  expect_well_formed(line_plot(kFrame, {{"a", {}, {}}}));
  expect_well_formed(line_plot(kFrame, {{"a", {1}, {NAN}}, {"b", {1}, {2}, true}}));
}

TEST(Histogram, counts_every_value_once) {
  PlotFrame frame = kFrame;
  frame.x.range = Range{0, 10};
  const std::string svg = histogram(frame, {0, 1, 1.5, 1.7, 9.9, 10, 11, NAN}, 10);
  expect_well_formed(svg);
  EXPECT_NE(svg.find("n = 8, 2 outside"), std::string::npos);
  EXPECT_EQ(count(svg, "class=\"f0\""), 3);
  // The bin [1, 2) holds three: it reaches the top of the frame where 3 is the greatest tick.
  std::vector<double> heights;
  const std::string ending = "\" class=\"f0\"";
  for (std::size_t at = svg.find(ending); at != std::string::npos; at = svg.find(ending, at + 1)) {
    heights.push_back(std::atof(svg.c_str() + svg.rfind('"', at - 1) + 1));
  }
  ASSERT_EQ(heights.size(), 3u);
  EXPECT_NEAR(heights[1] / heights[0], 3, 0.02);
  EXPECT_NEAR(heights[2] / heights[0], 2, 0.02);
}

TEST(Histogram, an_empty_sample_is_an_empty_frame) { expect_well_formed(histogram(kFrame, {})); }

TEST(BarChart, draws_a_bar_and_a_whisker_for_each_value_that_is_there) {
  const std::string svg =
      bar_chart(kFrame, {"pool", "dark", "murk"},
                {{"ours", {99, 95, NAN}, {{90, 100}, {80, 99}, {0, 1}}}, {"theirs", {30, -20, 5}}});
  expect_well_formed(svg);
  EXPECT_EQ(count(svg, "class=\"f0\""), 2 + 1);  // and the legend
  EXPECT_EQ(count(svg, "class=\"f1\""), 3 + 1);
  EXPECT_EQ(count(svg, "class=\"whisker\""), 2 * 3);
  EXPECT_EQ(count(svg, ">murk</text>"), 1);
}

TEST(HeatMapPlot, colours_cells_by_value_and_merges_runs) {
  HeatMap map;
  map.columns = 4;
  map.rows = 2;
  map.values = {0, 0, 0, 1, NAN, 0.5, 0.5, 1};
  map.x = {0, 3};
  map.y = {0, 1};
  map.value_name = "fitness";
  const std::string svg = heat_map(kFrame, map);
  expect_well_formed(svg);
  const int scale = 64;
  EXPECT_EQ(count(svg, "crispEdges"), scale + 4);
  EXPECT_EQ(count(svg, "class=\"missing\""), 1);
  EXPECT_NE(svg.find(scale_colour(1)), std::string::npos);
}

TEST(HeatMapPlot, names_rows_and_columns_and_prints_values) {
  HeatMap map;
  map.columns = 2;
  map.rows = 1;
  map.values = {12, 97};
  map.column_names = {"0 %", "30 %"};
  map.row_names = {"turbid"};
  map.print_values = true;
  const std::string svg = heat_map(kFrame, map);
  expect_well_formed(svg);
  for (const char* words : {">12</text>", ">97</text>", ">30 %</text>", ">turbid</text>"}) {
    EXPECT_EQ(count(svg, words), 1) << words;
  }
}

TEST(HeatMapPlot, sizes_that_do_not_fit_draw_no_cells) {
  HeatMap map;
  map.columns = 3;
  map.rows = 3;
  map.values = {1, 2};
  const std::string svg = heat_map(kFrame, map);
  expect_well_formed(svg);
  EXPECT_EQ(count(svg, "crispEdges"), 0);
}

// Relative luminance of the scale rises, so that it also reads in grey.
TEST(ScaleColour, grows_brighter_all_the_way) {
  double last = -1;
  for (int i = 0; i <= 100; ++i) {
    const unsigned long rgb = std::stoul(scale_colour(i / 100.0).substr(1), nullptr, 16);
    const double luminance = 0.2126 * static_cast<double>(rgb >> 16) +
                             0.7152 * static_cast<double>(rgb >> 8 & 255) +
                             0.0722 * static_cast<double>(rgb & 255);
    EXPECT_GE(luminance, last - 0.6) << i;
    last = luminance;
  }
  EXPECT_EQ(scale_colour(-3), scale_colour(0));
  EXPECT_EQ(scale_colour(7), scale_colour(1));
}

}  // namespace
}  // namespace gannet::report
