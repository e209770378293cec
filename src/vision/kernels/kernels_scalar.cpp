// The truth: plain loops in a fixed order. Every other variant equals this bit for bit.
#include <cmath>
#include <cstdlib>

#include "src/vision/kernels/kernels.hpp"

namespace gannet::vision {
namespace {

// The cell of a pixel position, or the guard. u and v may be NaN or beyond any int.
inline std::int32_t cell_of(float u, float v, float w, const PlaneView& view) {
  const float column = u + 0.5f;
  const float row = v + 0.5f;
  const bool inside = w > 0.0f && column >= 0.0f && column < static_cast<float>(view.width) &&
                      row >= 0.0f && row < static_cast<float>(view.height);
  return inside ? static_cast<std::int32_t>(row) * view.stride + static_cast<std::int32_t>(column)
                : view.guard;
}

// Where a point of the plane is seen: u and v over w.
struct Seen {
  float u, v, w;
};

template <bool kPort>
inline Seen see(const PlaneView& view, float x, float y) {
  const float* h = view.h;
  float w = (h[6] * x + h[7] * y) + h[8];
  float u = (h[0] * x + h[1] * y) + h[2];
  float v = (h[3] * x + h[4] * y) + h[5];
  if constexpr (kPort) {
    const float* e = view.e;
    const float r = std::sqrt(((e[0] * x + e[1] * y) + e[2]) * x + ((e[3] * y + e[4]) * y + e[5]));
    u = u + r * view.port[0];
    v = v + r * view.port[1];
    w = w + r * view.port[2];
  }
  return {u / w, v / w, w};
}

template <bool kPort>
int project(const float* x, const float* y, int n, const PlaneView& view, std::int32_t* index) {
  int inside = 0;
  for (int i = 0; i < n; ++i) {
    const auto [u, v, w] = see<kPort>(view, x[i], y[i]);
    index[i] = cell_of(u, v, w, view);
    inside += index[i] != view.guard;
  }
  return inside;
}

template <bool kPort>
int project_lens(const float* x, const float* y, int n, const PlaneView& view,
                 const LensTable& lens, std::int32_t* index) {
  int inside = 0;
  for (int i = 0; i < n; ++i) {
    const auto [a, b, w] = see<kPort>(view, x[i], y[i]);
    const float r2 = a * a + b * b;
    const bool valid = r2 <= lens.r2_max;
    const float s = valid ? r2 * lens.scale : 0.0f;
    const auto step = static_cast<std::int32_t>(s);
    const float low = lens.factor[step];
    const float factor = low + (lens.factor[step + 1] - low) * (s - static_cast<float>(step));
    const float ab2 = 2.0f * (a * b);
    const float da = lens.p1 * ab2 + lens.p2 * (r2 + 2.0f * (a * a));
    const float db = lens.p1 * (r2 + 2.0f * (b * b)) + lens.p2 * ab2;
    const float u = lens.fx * (a * factor + da) + lens.cx;
    const float v = lens.fy * (b * factor + db) + lens.cy;
    index[i] = valid ? cell_of(u, v, w, view) : view.guard;
    inside += index[i] != view.guard;
  }
  return inside;
}

void correlate(const std::uint32_t* cells, const std::int32_t* index, int n,
               const std::int8_t* model, bool all_visible, CorrelationSums& sums) {
  sums = {};
  for (int i = 0; i < n; ++i) {
    const std::uint32_t cell = cells[index[i]];
    const int visible = static_cast<int>(cell >> 24);
    const std::int8_t* m = model + (i / 4) * 16 + i % 4;
    for (int c = 0; c < 3; ++c) {
      const int value = static_cast<int>((cell >> (8 * c)) & 0xFF);
      const int expected = m[4 * c];
      sums.i[c] += value;
      sums.ii[c] += value * value;
      sums.im[c] += value * expected;
      if (all_visible) continue;
      sums.m[c] += visible * expected;
      sums.mm[c] += visible * expected * expected;
    }
  }
}

inline int hue_distance(int a, int b) {
  const int d = std::abs(a - b);
  return d < 256 - d ? d : 256 - d;
}

void vote(const std::uint16_t* cells, const std::int32_t* index, int n_in, int n_out, int guard,
          const std::uint8_t* hue, const std::uint8_t* flags, std::uint8_t background_hue,
          VoteCounts& counts) {
  counts = {};
  for (int i = 0; i < n_in; ++i) {
    if (index[i] == guard) continue;
    const int d = hue_distance(cells[index[i]] & 0xFF, hue[i]);
    const bool near = d <= kHueNear30;
    const bool far = d >= kHueFar50;
    const bool background = flags[i] != 0;
    counts.in_match += near;
    counts.in_far += far;
    counts.in_background += !near && !far && background;
    counts.in_far_background += far && background;
  }
  for (int i = n_in; i < n_in + n_out; ++i) {
    if (index[i] == guard) continue;
    const bool background = hue_distance(cells[index[i]] & 0xFF, background_hue) <= kHueNear20;
    counts.out_background += background;
    counts.out_other += !background;
  }
}

void compare(const std::uint16_t* cells, const std::int32_t* index, int n, int guard,
             const std::uint16_t* hue_value, ProjectionCounts& counts) {
  counts = {};
  for (int i = 0; i < n; ++i) {
    if (index[i] == guard) continue;
    const int cell = cells[index[i]];
    const bool hue = hue_distance(cell & 0xFF, hue_value[i] & 0xFF) <= kHueNear20;
    const bool value = std::abs((cell >> 8) - (hue_value[i] >> 8)) <= kValueNear;
    counts.hue_match += hue;
    counts.hue_other += !hue;
    counts.value_match += value;
    counts.value_other += !value;
  }
}

}  // namespace

const Kernels kScalarKernels = {
    "scalar", project<false>, project_lens<false>, project<true>, project_lens<true>, correlate,
    vote,     compare};

}  // namespace gannet::vision
