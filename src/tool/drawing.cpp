#include "src/tool/drawing.hpp"

#include <algorithm>
#include <cmath>

namespace gannet::tool {
namespace {

// The whole pixels of [low, high] inside [0, size).
std::pair<int, int> clipped(double low, double high, int size) {
  const double end = size - 1;
  return {static_cast<int>(std::ceil(std::clamp(low, 0.0, end + 1))),
          static_cast<int>(std::floor(std::clamp(high, -1.0, end)))};
}

}  // namespace

void draw_line(hal::Image& picture, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
               double width, Colour colour) {
  if (!from.allFinite() || !to.allFinite()) return;
  const double half = 0.5 * std::max(width, 1.0);
  const Eigen::Vector2d low = from.cwiseMin(to).array() - half;
  const Eigen::Vector2d high = from.cwiseMax(to).array() + half;
  const auto [x0, x1] = clipped(low.x(), high.x(), picture.width());
  const auto [y0, y1] = clipped(low.y(), high.y(), picture.height());
  const Eigen::Vector2d along = to - from;
  const double length2 = std::max(along.squaredNorm(), 1e-12);
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const Eigen::Vector2d p = Eigen::Vector2d(x, y) - from;
      const double t = std::clamp(p.dot(along) / length2, 0.0, 1.0);
      if ((p - t * along).squaredNorm() <= half * half)
        std::copy(colour.begin(), colour.end(), picture.row(0, y) + 3 * x);
    }
}

void draw_dot(hal::Image& picture, const Eigen::Vector2d& at, double radius, Colour colour) {
  draw_line(picture, at, at, 2 * radius, colour);
}

void put(hal::Image& picture, const hal::Image& source, int left, int top, int scale) {
  for (int y = 0; y < source.height() * scale; ++y)
    for (int x = 0; x < source.width() * scale; ++x)
      std::copy_n(source.row(0, y / scale) + 3 * (x / scale), 3,
                  picture.row(0, top + y) + 3 * (left + x));
}

}  // namespace gannet::tool
