#include "src/report/svg_canvas.hpp"

#include "src/report/table.hpp"

namespace gannet::report {
namespace {

constexpr int kSeries = 7;

// Okabe & Ito's colours without black and yellow (no contrast on one ground or the other), and a
// grey; on dark ground the blue and the vermilion are lightened.
constexpr const char* kOnLight[kSeries] = {"#0072b2", "#d55e00", "#009e73", "#b8609a",
                                           "#c98500", "#3f9fd8", "#6b6b6b"};
constexpr const char* kOnDark[kSeries] = {"#4aa8e0", "#ff8a47", "#2ec79b", "#e199c6",
                                          "#f0b93a", "#9ad4f5", "#b0b0b0"};
// Dashes tell lines apart where colours do not.
constexpr const char* kDashes[kSeries] = {"none", "7 3", "2 2.5", "9 3 2 3",
                                          "none", "7 3", "2 2.5"};

std::string style_sheet() {
  std::string css =
      ".gp{font-family:system-ui,'DejaVu Sans',Helvetica,Arial,sans-serif;font-size:12px}"
      ".gp .text,.gp .vertical{fill:#333a42}.gp .title{font-size:14px;font-weight:600;fill:#14181c}"
      ".gp .small{font-size:11px;fill:#59626c}"
      ".gp .grid{stroke:#e3e7eb;stroke-width:1;fill:none}"
      ".gp .axis{stroke:#9aa4ae;stroke-width:1;fill:none}"
      ".gp .level{stroke:#59626c;stroke-width:1.2;stroke-dasharray:4 4;fill:none}"
      // What stands on lines and bars: a rim in the ground's colour.
      ".gp .halo{paint-order:stroke;stroke:#fff;stroke-width:3px;stroke-linejoin:round}"
      ".gp .whisker{stroke:#14181c;stroke-width:1.3;fill:none}"
      ".gp .missing{fill:#d5dade}"
      // On the heat map's own colours, which are the same on both grounds.
      ".gp .on-dark{fill:#f4f6f8}.gp .on-light{fill:#14181c}";
  std::string dark =
      ".gp .text,.gp .vertical{fill:#c6ced6}.gp .title{fill:#f0f3f6}.gp .small{fill:#98a3ad}"
      ".gp .grid{stroke:#2b333b}.gp .axis{stroke:#66717b}.gp .level{stroke:#a6b0ba}"
      ".gp .halo{stroke:#14181c}.gp .whisker{stroke:#f0f3f6}.gp .missing{fill:#39424b}";
  for (int i = 0; i < kSeries; ++i) {
    const std::string n = std::to_string(i);
    css += ".gp .l" + n + "{stroke:" + kOnLight[i] + ";stroke-dasharray:" + kDashes[i] +
           ";stroke-width:1.6;fill:none;stroke-linejoin:round;stroke-linecap:round}" + ".gp .f" +
           n + "{fill:" + kOnLight[i] + "}";
    dark += ".gp .l" + n + "{stroke:" + kOnDark[i] + "}.gp .f" + n + "{fill:" + kOnDark[i] + "}";
  }
  return css + "@media (prefers-color-scheme:dark){" + dark + "}";
}

std::string attribute(std::string_view name, double value) {
  return " " + std::string(name) + "=\"" + number(value, 1) + "\"";
}

std::string style_of(std::string_view style) { return " class=\"" + std::string(style) + "\""; }

}  // namespace

SvgCanvas::SvgCanvas(int width, int height, std::string_view title) {
  const std::string w = std::to_string(width);
  const std::string h = std::to_string(height);
  svg_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"gp\" role=\"img\" width=\"" + w +
         "\" height=\"" + h + "\" viewBox=\"0 0 " + w + " " + h + "\">\n<title>" + escaped(title) +
         "</title>\n<style>" + style_sheet() + "</style>\n";
}

void SvgCanvas::line(double x1, double y1, double x2, double y2, std::string_view style) {
  svg_ += "<line" + attribute("x1", x1) + attribute("y1", y1) + attribute("x2", x2) +
          attribute("y2", y2) + style_of(style) + "/>\n";
}

void SvgCanvas::rectangle(double x, double y, double width, double height, std::string_view style) {
  svg_ += "<rect" + attribute("x", x) + attribute("y", y) + attribute("width", width) +
          attribute("height", height) + style_of(style) + "/>\n";
}

void SvgCanvas::filled(double x, double y, double width, double height, std::string_view colour) {
  svg_ += "<rect" + attribute("x", x) + attribute("y", y) + attribute("width", width) +
          attribute("height", height) + " fill=\"" + std::string(colour) +
          "\" shape-rendering=\"crispEdges\"/>\n";
}

void SvgCanvas::polyline(const std::vector<std::pair<double, double>>& points,
                         std::string_view style) {
  if (points.empty()) return;
  svg_ += "<polyline" + style_of(style) + " points=\"";
  for (std::size_t i = 0; i < points.size(); ++i) {
    svg_ += (i > 0 ? " " : "") + number(points[i].first, 1) + "," + number(points[i].second, 1);
  }
  svg_ += "\"/>\n";
}

void SvgCanvas::dot(double x, double y, double radius, std::string_view style) {
  svg_ += "<circle" + attribute("cx", x) + attribute("cy", y) + attribute("r", radius) +
          style_of(style) + "/>\n";
}

void SvgCanvas::text(double x, double y, std::string_view words, std::string_view style,
                     Anchor anchor) {
  const char* where = anchor == Anchor::kStart ? "start"
                      : anchor == Anchor::kEnd ? "end"
                                               : "middle";
  svg_ += "<text" + attribute("x", x) + attribute("y", y) + style_of(style) + " text-anchor=\"" +
          where + "\">" + escaped(words) + "</text>\n";
}

void SvgCanvas::vertical_text(double x, double y, std::string_view words) {
  svg_ += "<text class=\"vertical\" text-anchor=\"middle\" transform=\"translate(" + number(x, 1) +
          " " + number(y, 1) + ") rotate(-90)\">" + escaped(words) + "</text>\n";
}

// A nested picture clips without an id that would have to be unique in a page.
void SvgCanvas::begin_clip(double x, double y, double width, double height) {
  svg_ += "<svg" + attribute("x", x) + attribute("y", y) + attribute("width", width) +
          attribute("height", height) + " viewBox=\"" + number(x, 1) + " " + number(y, 1) + " " +
          number(width, 1) + " " + number(height, 1) + "\">\n";
}

std::string series_line(int i) { return "l" + std::to_string(i % kSeries); }
std::string series_fill(int i) { return "f" + std::to_string(i % kSeries); }

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        // XML has no control characters but these.
        if (static_cast<unsigned char>(c) >= 32 || c == '\n' || c == '\t') result += c;
    }
  }
  return result;
}

double text_pixels(std::string_view words) { return 6.6 * text_width(words); }

}  // namespace gannet::report
