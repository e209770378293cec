#include "src/image_file/drawing.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <vector>

namespace gannet::image_file {
namespace {

bool is_finite(Point p) { return std::isfinite(p.x) && std::isfinite(p.y); }

// The whole numbers from low to high that lie within 0 … size − 1.
struct Span {
  int begin, end;
};
Span whole_within(double low, double high, int size) {
  return {static_cast<int>(std::ceil(std::clamp(low, 0.0, static_cast<double>(size)))),
          static_cast<int>(std::floor(std::clamp(high, -1.0, size - 1.0))) + 1};
}

double distance_to_segment(Point p, Point a, Point b) {
  const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
  const double t =
      length2 > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length2, 0.0, 1.0) : 0;
  return std::hypot(a.x + t * dx - p.x, a.y + t * dy - p.y);
}

// The x range of the part of a segment whose y is within reach of the row.
std::pair<double, double> reach_in_row(Point a, Point b, double y, double reach) {
  const double dy = b.y - a.y;
  double t0 = 0, t1 = 1;
  if (std::abs(dy) > 1e-9) {
    const double u = (y - reach - a.y) / dy, v = (y + reach - a.y) / dy;
    t0 = std::clamp(std::min(u, v), 0.0, 1.0);
    t1 = std::clamp(std::max(u, v), 0.0, 1.0);
  }
  const double x0 = a.x + t0 * (b.x - a.x), x1 = a.x + t1 * (b.x - a.x);
  return {std::min(x0, x1) - reach, std::max(x0, x1) + reach};
}

// Where the horizontal line at y crosses the polygon's edges, in order.
std::vector<double> crossings(std::span<const Point> corners, double y) {
  std::vector<double> xs;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point a = corners[i], b = corners[(i + 1) % corners.size()];
    if ((a.y <= y) != (b.y <= y)) xs.push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
  }
  std::sort(xs.begin(), xs.end());
  return xs;
}

// Adds weight × the share of each pixel that the interval covers.
void cover(std::vector<double>& row, double from, double to, double weight) {
  const auto [begin, end] = whole_within(from - 0.5, to + 0.5, static_cast<int>(row.size()));
  for (int x = begin; x < end; ++x) {
    const double share = std::min(to, x + 0.5) - std::max(from, x - 0.5);
    row[static_cast<std::size_t>(x)] += weight * std::clamp(share, 0.0, 1.0);
  }
}

}  // namespace

Canvas::Canvas(hal::Image& image) : image_(image) {
  assert(image.format() == hal::PixelFormat::kRgb24);
}

void Canvas::blend(int x, int y, Colour colour, double opacity) {
  std::uint8_t* pixel = image_.row(0, y) + 3 * x;
  const std::array<std::uint8_t, 3> wanted = {colour.r, colour.g, colour.b};
  for (std::size_t i = 0; i < 3; ++i)
    pixel[i] = hal::to_byte(pixel[i] + opacity * (wanted[i] - pixel[i]));
}

void Canvas::fill(Colour colour) {
  for (int y = 0; y < image_.height(); ++y)
    for (int x = 0; x < image_.width(); ++x) blend(x, y, colour, 1);
}

void Canvas::line(Point a, Point b, Colour colour, double width, double opacity) {
  if (!is_finite(a) || !is_finite(b)) return;
  const double reach = width / 2 + 0.5;  // coverage falls from 1 to 0 over one pixel
  const auto rows =
      whole_within(std::min(a.y, b.y) - reach, std::max(a.y, b.y) + reach, image_.height());
  for (int y = rows.begin; y < rows.end; ++y) {
    const auto [low, high] = reach_in_row(a, b, y, reach);
    const auto columns = whole_within(low, high, image_.width());
    for (int x = columns.begin; x < columns.end; ++x) {
      const double d = distance_to_segment({static_cast<double>(x), static_cast<double>(y)}, a, b);
      const double coverage = std::clamp(reach - d, 0.0, std::min(width, 1.0));
      if (coverage > 0) blend(x, y, colour, coverage * opacity);
    }
  }
}

void Canvas::outline(std::span<const Point> corners, Colour colour, double width) {
  for (std::size_t i = 0; i < corners.size(); ++i)
    line(corners[i], corners[(i + 1) % corners.size()], colour, width);
}

void Canvas::polygon(std::span<const Point> corners, Colour colour, double opacity) {
  if (!std::all_of(corners.begin(), corners.end(), is_finite) || corners.size() < 3) return;
  const auto [low, high] = std::minmax_element(corners.begin(), corners.end(),
                                               [](Point a, Point b) { return a.y < b.y; });
  const auto rows = whole_within(low->y - 0.5, high->y + 0.5, image_.height());
  constexpr int kLines = 4;  // sub-lines a row; along x the coverage is exact
  std::vector<double> row(static_cast<std::size_t>(image_.width()));
  for (int y = rows.begin; y < rows.end; ++y) {
    std::fill(row.begin(), row.end(), 0.0);
    for (int i = 0; i < kLines; ++i) {
      const auto xs = crossings(corners, y - 0.5 + (i + 0.5) / kLines);
      for (std::size_t k = 0; k + 1 < xs.size(); k += 2) cover(row, xs[k], xs[k + 1], 1.0 / kLines);
    }
    for (int x = 0; x < image_.width(); ++x) {
      const double coverage = std::min(row[static_cast<std::size_t>(x)], 1.0);
      if (coverage > 0) blend(x, y, colour, coverage * opacity);
    }
  }
}

void Canvas::circle(Point centre, double radius, Colour colour, double width) {
  if (!is_finite(centre) || !std::isfinite(radius)) return;
  const double reach = width / 2 + 0.5, outer = radius + reach;
  const auto rows = whole_within(centre.y - outer, centre.y + outer, image_.height());
  const auto columns = whole_within(centre.x - outer, centre.x + outer, image_.width());
  for (int y = rows.begin; y < rows.end; ++y)
    for (int x = columns.begin; x < columns.end; ++x) {
      const double d = std::abs(std::hypot(x - centre.x, y - centre.y) - radius);
      const double coverage = std::clamp(reach - d, 0.0, std::min(width, 1.0));
      if (coverage > 0) blend(x, y, colour, coverage);
    }
}

void Canvas::disc(Point centre, double radius, Colour colour, double opacity) {
  line(centre, centre, colour, 2 * radius, opacity);
}

void Canvas::arrow(Point from, Point to, Colour colour, double width) {
  line(from, to, colour, width);
  const double dx = (from.x - to.x) / 5, dy = (from.y - to.y) / 5;
  line(to, {to.x + dx - dy / 2, to.y + dy + dx / 2}, colour, width);
  line(to, {to.x + dx + dy / 2, to.y + dy - dx / 2}, colour, width);
}

void Canvas::blit(const hal::ImageView& source, int x, int y) {
  for (int row = std::max(0, -y); row < source.height && row + y < image_.height(); ++row)
    for (int column = std::max(0, -x); column < source.width && column + x < image_.width();
         ++column)
      blend(column + x, row + y, hal::rgb_at(source, column, row), 1);
}

hal::Image side_by_side(const hal::ImageView& left, const hal::ImageView& right, int gap) {
  hal::Image image(left.width + gap + right.width, std::max(left.height, right.height),
                   hal::PixelFormat::kRgb24);
  Canvas canvas(image);
  canvas.blit(left, 0, 0);
  canvas.blit(right, left.width + gap, 0);
  return image;
}

Colour heat_colour(double x) {
  x = std::clamp(x, 0.0, 1.0);
  const double angle = 2 * std::numbers::pi * (0.5 / 3 - 1.5 * x);
  const double amplitude = x * (1 - x) / 2, c = std::cos(angle), s = std::sin(angle);
  const auto channel = [&](double of_cos, double of_sin) {
    return hal::to_byte(255 * (x + amplitude * (of_cos * c + of_sin * s)));
  };
  return {channel(-0.14861, 1.78277), channel(-0.29227, -0.90649), channel(1.97294, 0)};
}

hal::Image heat_map(std::span<const double> values, int width, int height, double low, double high,
                    int scale) {
  assert(values.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  hal::Image image(width * scale, height * scale, hal::PixelFormat::kRgb24);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const double value =
          values[static_cast<std::size_t>(y / scale) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(x / scale)];
      const Colour colour = !std::isfinite(value) ? colours::kGrey
                            : high > low          ? heat_colour((value - low) / (high - low))
                                                  : heat_colour(0);
      std::uint8_t* pixel = image.row(0, y) + 3 * x;
      pixel[0] = colour.r, pixel[1] = colour.g, pixel[2] = colour.b;
    }
  return image;
}

}  // namespace gannet::image_file
