// SvgCanvas: writes one SVG picture whose colours follow the reader's light or dark setting. Series
// colours are the eight of Okabe & Ito (safe for colour-blind readers), lightened on dark ground.
// Pixel coordinates, x right, y down. Any thread; a value. The picture stands alone or in HTML.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gannet::report {

enum class Anchor { kStart, kMiddle, kEnd };

class SvgCanvas {
 public:
  // title is read out by screen readers.
  SvgCanvas(int width, int height, std::string_view title);

  // style: a CSS class of the picture: "grid", "axis", "level", "whisker", "missing",
  // series_line(i), series_fill(i).
  void line(double x1, double y1, double x2, double y2, std::string_view style);
  void rectangle(double x, double y, double width, double height, std::string_view style);
  void filled(double x, double y, double width, double height, std::string_view colour);
  void polyline(const std::vector<std::pair<double, double>>& points, std::string_view style);
  void dot(double x, double y, double radius, std::string_view style);
  // style "title", "text", "small", "small halo", "on-dark" and "on-light" (of a filled colour).
  void text(double x, double y, std::string_view words, std::string_view style, Anchor anchor);
  void vertical_text(double x, double y, std::string_view words);  // upwards, centred

  // What is drawn between the two is cut off at the rectangle's border.
  void begin_clip(double x, double y, double width, double height);
  void end_clip() { svg_ += "</svg>\n"; }

  // The finished picture.
  std::string svg() const { return svg_ + "</svg>\n"; }

 private:
  std::string svg_;
};

// The classes of the i-th series: as a line, as a filled area.
std::string series_line(int i);
std::string series_fill(int i);

// & < > " as XML wants them.
std::string escaped(std::string_view text);

// About how many pixels words take in "text" style.
double text_pixels(std::string_view words);

}  // namespace gannet::report
