#include "src/vision/point_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "src/vision/hue_value.hpp"
#include "src/vision/kernels/kernels.hpp"

namespace gannet::vision {
namespace {

constexpr int kBackgroundNear = kHueNear30;

std::array<float, 3> channels(const Yuv& c) { return {c.y, c.u, c.v}; }

}  // namespace

void PointSet::reserve(int max_points) {
  const auto n = static_cast<std::size_t>(padded(max_points) + 2 * kLanes);
  x.reserve(n);
  y.reserve(n);
  z.reserve(n);
  colour.reserve(n);
  hue.reserve(n);
  is_background.reserve(n);
  hue_value.reserve(n);
  correlation.reserve(4 * n);
}

void PointSet::assign(const std::vector<ModelPoint>& points, const Yuv& background,
                      std::uint8_t background_hue, bool own_outside) {
  inside = static_cast<int>(
      std::count_if(points.begin(), points.end(), [](const ModelPoint& p) { return p.inside; }));
  outside = static_cast<int>(points.size()) - inside;
  inside_padded = padded(inside);
  total_padded = inside_padded + padded(outside);
  const auto n = static_cast<std::size_t>(total_padded);
  x.assign(n, std::numeric_limits<float>::quiet_NaN());
  y.assign(n, std::numeric_limits<float>::quiet_NaN());
  z.clear();
  colour.assign(n, Yuv{});
  hue.assign(n, 0);
  is_background.assign(n, 0);
  hue_value.assign(n, 0);
  correlation.assign(4 * n, 0);

  const auto is_core = [](const ModelPoint& p) { return p.inside && !p.border; };
  const auto all_core = std::count_if(points.begin(), points.end(), is_core);
  core = static_cast<int>(all_core) / kLanes * kLanes;
  std::size_t next_core = 0;
  auto next_border = static_cast<std::size_t>(all_core);
  auto next_out = static_cast<std::size_t>(inside_padded);
  float reach2 = 0;
  for (const ModelPoint& p : points) {
    reach2 = std::max(reach2, p.x_m * p.x_m + p.y_m * p.y_m);
    const std::size_t i = is_core(p) ? next_core++ : p.inside ? next_border++ : next_out++;
    x[i] = p.x_m;
    y[i] = p.y_m;
    colour[i] = p.inside || own_outside ? p.colour : background;
    hue_value[i] = hue_value_of(p.colour);
    hue[i] = static_cast<std::uint8_t>(hue_value[i] & 0xFF);
    const bool near = hue_distance(hue[i], background_hue) <= kBackgroundNear;
    is_background[i] = p.inside && near ? 0xFF : 0;
  }
  reach = std::sqrt(reach2);

  for (std::size_t c = 0; c < 3; ++c) {
    float low = std::numeric_limits<float>::max();
    float high = std::numeric_limits<float>::lowest();
    for (std::size_t i = 0; i < n; ++i) {
      if (std::isnan(x[i])) continue;
      low = std::min(low, channels(colour[i])[c]);
      high = std::max(high, channels(colour[i])[c]);
    }
    const float range = std::max(high - low, 16.0f);
    const float middle = (high + low) / 2;
    grey_per_step[c] = range / 126.0f;
    sum[c] = sum_squares[c] = 0;
    inside_sum[c] = inside_squares[c] = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (std::isnan(x[i])) continue;
      const float step = (channels(colour[i])[c] - middle) / grey_per_step[c];
      const auto m = static_cast<std::int8_t>(std::lround(std::clamp(step, -63.0f, 63.0f)));
      correlation[i / 4 * 16 + 4 * c + i % 4] = m;
      sum[c] += m;
      sum_squares[c] += m * m;
      if (i >= static_cast<std::size_t>(inside_padded)) continue;
      inside_sum[c] += m;
      inside_squares[c] += m * m;
    }
  }
}

void coarsen(const std::vector<ModelPoint>& points, double spacing, double factor,
             std::vector<ModelPoint>& out) {
  out = points;
  if (factor <= 1) return;
  const double cell = spacing * factor;
  const auto key_of = [cell](const ModelPoint& p) {
    return std::tuple(!p.inside, static_cast<int>(std::floor(p.y_m / cell)),
                      static_cast<int>(std::floor(p.x_m / cell)));
  };
  // Sorting in place needs no heap; ties by position keep the sums' order the same everywhere.
  std::sort(out.begin(), out.end(), [&](const ModelPoint& a, const ModelPoint& b) {
    return std::tuple(key_of(a), a.y_m, a.x_m) < std::tuple(key_of(b), b.y_m, b.x_m);
  });
  const double least = 0.4 * factor * factor;  // points that make a cell
  std::size_t kept = 0;
  for (std::size_t begin = 0, end = 0; begin < out.size(); begin = end) {
    ModelPoint sum = out[begin];
    for (end = begin + 1; end < out.size() && key_of(out[end]) == key_of(out[begin]); ++end) {
      sum.x_m += out[end].x_m;
      sum.y_m += out[end].y_m;
      sum.border |= out[end].border;
      sum.colour.y += out[end].colour.y;
      sum.colour.u += out[end].colour.u;
      sum.colour.v += out[end].colour.v;
    }
    const auto n = static_cast<float>(end - begin);
    if (n < least) continue;
    sum.x_m /= n;
    sum.y_m /= n;
    sum.colour = {sum.colour.y / n, sum.colour.u / n, sum.colour.v / n};
    out[kept++] = sum;
  }
  out.resize(kept);
}

}  // namespace gannet::vision
