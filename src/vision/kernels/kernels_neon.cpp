// NEON (AArch64): four points a step, scalar loads in place of a gather. Same bits as
// kernels_scalar.cpp: no fused operations, true division.
#include <arm_neon.h>

#include "src/vision/kernels/kernels.hpp"

namespace gannet::vision {
namespace {

struct View4 {
  const PlaneView& view;
  float32x4_t width, height;
  int32x4_t stride, guard;

  explicit View4(const PlaneView& v)
      : view(v),
        width(vdupq_n_f32(static_cast<float>(v.width))),
        height(vdupq_n_f32(static_cast<float>(v.height))),
        stride(vdupq_n_s32(v.stride)),
        guard(vdupq_n_s32(v.guard)) {}

  static float32x4_t row(const float* c, float32x4_t x, float32x4_t y) {
    return vaddq_f32(vaddq_f32(vmulq_f32(vdupq_n_f32(c[0]), x), vmulq_f32(vdupq_n_f32(c[1]), y)),
                     vdupq_n_f32(c[2]));
  }

  // Where four points of the plane are seen: u and v over w.
  template <bool kPort>
  void see(float32x4_t x, float32x4_t y, float32x4_t& u, float32x4_t& v, float32x4_t& w) const {
    w = row(view.h + 6, x, y);
    u = row(view.h, x, y);
    v = row(view.h + 3, x, y);
    if constexpr (kPort) {
      const float* const e = view.e;
      const float32x4_t by_x = vmulq_f32(row(e, x, y), x);
      const float32x4_t by_y =
          vmulq_f32(vaddq_f32(vmulq_f32(vdupq_n_f32(e[3]), y), vdupq_n_f32(e[4])), y);
      const float32x4_t r = vsqrtq_f32(vaddq_f32(by_x, vaddq_f32(by_y, vdupq_n_f32(e[5]))));
      u = vaddq_f32(u, vmulq_f32(r, vdupq_n_f32(view.port[0])));
      v = vaddq_f32(v, vmulq_f32(r, vdupq_n_f32(view.port[1])));
      w = vaddq_f32(w, vmulq_f32(r, vdupq_n_f32(view.port[2])));
    }
    u = vdivq_f32(u, w);
    v = vdivq_f32(v, w);
  }

  // Cells of four pixel positions; adds how many are inside.
  int32x4_t cells(float32x4_t u, float32x4_t v, float32x4_t w, uint32x4_t valid,
                  int& inside) const {
    const float32x4_t half = vdupq_n_f32(0.5f);
    const float32x4_t zero = vdupq_n_f32(0.0f);
    const float32x4_t column = vaddq_f32(u, half);
    const float32x4_t line = vaddq_f32(v, half);
    uint32x4_t ok = vandq_u32(valid, vcgtq_f32(w, zero));
    ok = vandq_u32(ok, vandq_u32(vcgeq_f32(column, zero), vcltq_f32(column, width)));
    ok = vandq_u32(ok, vandq_u32(vcgeq_f32(line, zero), vcltq_f32(line, height)));
    const int32x4_t cell = vaddq_s32(vmulq_s32(vcvtq_s32_f32(line), stride), vcvtq_s32_f32(column));
    inside += static_cast<int>(vaddvq_u32(vshrq_n_u32(ok, 31)));
    return vbslq_s32(ok, cell, guard);
  }
};

template <bool kPort>
int project(const float* x, const float* y, int n, const PlaneView& view, std::int32_t* index) {
  const View4 v4(view);
  const uint32x4_t all = vdupq_n_u32(0xFFFFFFFFu);
  int inside = 0;
  for (int i = 0; i < n; i += 4) {
    const float32x4_t xs = vld1q_f32(x + i);
    const float32x4_t ys = vld1q_f32(y + i);
    float32x4_t u, v, w;
    v4.see<kPort>(xs, ys, u, v, w);
    vst1q_s32(index + i, v4.cells(u, v, w, all, inside));
  }
  return inside;
}

inline float32x4_t look_up(const float* table, int32x4_t at) {
  const float values[4] = {table[vgetq_lane_s32(at, 0)], table[vgetq_lane_s32(at, 1)],
                           table[vgetq_lane_s32(at, 2)], table[vgetq_lane_s32(at, 3)]};
  return vld1q_f32(values);
}

template <bool kPort>
int project_lens(const float* x, const float* y, int n, const PlaneView& view,
                 const LensTable& lens, std::int32_t* index) {
  const View4 v4(view);
  const float32x4_t two = vdupq_n_f32(2.0f);
  const float32x4_t p1 = vdupq_n_f32(lens.p1);
  const float32x4_t p2 = vdupq_n_f32(lens.p2);
  int inside = 0;
  for (int i = 0; i < n; i += 4) {
    const float32x4_t xs = vld1q_f32(x + i);
    const float32x4_t ys = vld1q_f32(y + i);
    float32x4_t a, b, w;
    v4.see<kPort>(xs, ys, a, b, w);
    const float32x4_t aa = vmulq_f32(a, a);
    const float32x4_t bb = vmulq_f32(b, b);
    const float32x4_t r2 = vaddq_f32(aa, bb);
    const uint32x4_t valid = vcleq_f32(r2, vdupq_n_f32(lens.r2_max));
    const float32x4_t s = vreinterpretq_f32_u32(
        vandq_u32(valid, vreinterpretq_u32_f32(vmulq_f32(r2, vdupq_n_f32(lens.scale)))));
    const int32x4_t step = vcvtq_s32_f32(s);
    const float32x4_t low = look_up(lens.factor, step);
    const float32x4_t high = look_up(lens.factor + 1, step);
    const float32x4_t factor =
        vaddq_f32(low, vmulq_f32(vsubq_f32(high, low), vsubq_f32(s, vcvtq_f32_s32(step))));
    const float32x4_t ab2 = vmulq_f32(two, vmulq_f32(a, b));
    const float32x4_t da =
        vaddq_f32(vmulq_f32(p1, ab2), vmulq_f32(p2, vaddq_f32(r2, vmulq_f32(two, aa))));
    const float32x4_t db =
        vaddq_f32(vmulq_f32(p1, vaddq_f32(r2, vmulq_f32(two, bb))), vmulq_f32(p2, ab2));
    const float32x4_t u = vaddq_f32(
        vmulq_f32(vdupq_n_f32(lens.fx), vaddq_f32(vmulq_f32(a, factor), da)), vdupq_n_f32(lens.cx));
    const float32x4_t v = vaddq_f32(
        vmulq_f32(vdupq_n_f32(lens.fy), vaddq_f32(vmulq_f32(b, factor), db)), vdupq_n_f32(lens.cy));
    vst1q_s32(index + i, v4.cells(u, v, w, valid, inside));
  }
  return inside;
}

// Adds 16 products of 8-bit values to the lanes [Y Y U U] and [V V - -].
struct ChannelTotals {
  int32x4_t yu = vdupq_n_s32(0);
  int32x4_t v = vdupq_n_s32(0);

  void add(int8x16_t a, int8x16_t b) {
    yu = vpadalq_s16(yu, vmull_s8(vget_low_s8(a), vget_low_s8(b)));
    v = vpadalq_s16(v, vmull_s8(vget_high_s8(a), vget_high_s8(b)));
  }
  void store(std::int32_t* out) const {
    out[0] = vgetq_lane_s32(yu, 0) + vgetq_lane_s32(yu, 1);
    out[1] = vgetq_lane_s32(yu, 2) + vgetq_lane_s32(yu, 3);
    out[2] = vgetq_lane_s32(v, 0) + vgetq_lane_s32(v, 1);
  }
};

void correlate(const std::uint32_t* cells, const std::int32_t* index, int n,
               const std::int8_t* model, bool all_visible, CorrelationSums& sums) {
  static const std::uint8_t kByChannel[16] = {0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15};
  const uint8x16_t by_channel = vld1q_u8(kByChannel);
  const int8x16_t ones = vdupq_n_s8(1);
  ChannelTotals i1, ii, im, m1, mm;
  for (int i = 0; i < n; i += 4) {
    const std::uint32_t four[4] = {cells[index[i]], cells[index[i + 1]], cells[index[i + 2]],
                                   cells[index[i + 3]]};
    const uint8x16_t raw = vreinterpretq_u8_u32(vld1q_u32(four));
    const int8x16_t pixel = vreinterpretq_s8_u8(vqtbl1q_u8(raw, by_channel));
    const int8x16_t expected = vld1q_s8(model + 4 * i);
    i1.add(pixel, ones);
    ii.add(pixel, pixel);
    im.add(pixel, expected);
    if (all_visible) continue;
    const int8x16_t visible = vreinterpretq_s8_s32(vdupq_laneq_s32(vreinterpretq_s32_s8(pixel), 3));
    const int8x16_t seen = vmulq_s8(expected, visible);
    m1.add(seen, ones);
    mm.add(seen, seen);
  }
  i1.store(sums.i);
  ii.store(sums.ii);
  im.store(sums.im);
  m1.store(sums.m);
  mm.store(sums.mm);
}

inline int32x4_t load_bytes(const std::uint8_t* bytes) {
  const std::int32_t values[4] = {bytes[0], bytes[1], bytes[2], bytes[3]};
  return vld1q_s32(values);
}

inline int32x4_t gather_cells(const std::uint16_t* cells, const std::int32_t* index) {
  const std::int32_t values[4] = {cells[index[0]], cells[index[1]], cells[index[2]],
                                  cells[index[3]]};
  return vld1q_s32(values);
}

inline int32x4_t circular_distance(int32x4_t a, int32x4_t b) {
  const int32x4_t d = vabdq_s32(a, b);
  return vminq_s32(d, vsubq_s32(vdupq_n_s32(256), d));
}

inline uint32x4_t not_above(int32x4_t value, int limit) {
  return vcleq_s32(value, vdupq_n_s32(limit));
}

// Counts lanes whose mask is set.
struct Count {
  uint32x4_t lanes = vdupq_n_u32(0);
  void add(uint32x4_t mask) { lanes = vsubq_u32(lanes, mask); }
  std::int32_t total() const { return static_cast<std::int32_t>(vaddvq_u32(lanes)); }
};

void vote(const std::uint16_t* cells, const std::int32_t* index, int n_in, int n_out, int guard,
          const std::uint8_t* hue, const std::uint8_t* flags, std::uint8_t background_hue,
          VoteCounts& counts) {
  const int32x4_t outside = vdupq_n_s32(guard);
  const int32x4_t hue_mask = vdupq_n_s32(0xFF);
  Count match, far, background, far_background, out_background, out_other;
  for (int i = 0; i < n_in; i += 4) {
    const uint32x4_t shown = vmvnq_u32(vceqq_s32(vld1q_s32(index + i), outside));
    const int32x4_t seen = vandq_s32(gather_cells(cells, index + i), hue_mask);
    const int32x4_t d = circular_distance(seen, load_bytes(hue + i));
    const uint32x4_t is_match = vandq_u32(shown, not_above(d, kHueNear30));
    const uint32x4_t is_far = vandq_u32(shown, vcgeq_s32(d, vdupq_n_s32(kHueFar50)));
    const uint32x4_t flagged = vcgtq_s32(load_bytes(flags + i), vdupq_n_s32(0));
    const uint32x4_t rest = vbicq_u32(shown, vorrq_u32(is_match, is_far));
    match.add(is_match);
    far.add(is_far);
    background.add(vandq_u32(rest, flagged));
    far_background.add(vandq_u32(is_far, flagged));
  }
  const int32x4_t bg = vdupq_n_s32(background_hue);
  for (int i = n_in; i < n_in + n_out; i += 4) {
    const uint32x4_t shown = vmvnq_u32(vceqq_s32(vld1q_s32(index + i), outside));
    const int32x4_t seen = vandq_s32(gather_cells(cells, index + i), hue_mask);
    const uint32x4_t near = not_above(circular_distance(seen, bg), kHueNear20);
    out_background.add(vandq_u32(shown, near));
    out_other.add(vbicq_u32(shown, near));
  }
  counts = {match.total(),          far.total(),      background.total(), far_background.total(),
            out_background.total(), out_other.total()};
}

void compare(const std::uint16_t* cells, const std::int32_t* index, int n, int guard,
             const std::uint16_t* hue_value, ProjectionCounts& counts) {
  const int32x4_t outside = vdupq_n_s32(guard);
  const int32x4_t low = vdupq_n_s32(0xFF);
  Count hue_match, hue_other, value_match, value_other;
  for (int i = 0; i < n; i += 4) {
    const uint32x4_t shown = vmvnq_u32(vceqq_s32(vld1q_s32(index + i), outside));
    const int32x4_t seen = gather_cells(cells, index + i);
    const std::int32_t own[4] = {hue_value[i], hue_value[i + 1], hue_value[i + 2],
                                 hue_value[i + 3]};
    const int32x4_t expected = vld1q_s32(own);
    const uint32x4_t hue =
        not_above(circular_distance(vandq_s32(seen, low), vandq_s32(expected, low)), kHueNear20);
    const uint32x4_t value =
        not_above(vabdq_s32(vshrq_n_s32(seen, 8), vshrq_n_s32(expected, 8)), kValueNear);
    hue_match.add(vandq_u32(shown, hue));
    hue_other.add(vbicq_u32(shown, hue));
    value_match.add(vandq_u32(shown, value));
    value_other.add(vbicq_u32(shown, value));
  }
  counts = {hue_match.total(), hue_other.total(), value_match.total(), value_other.total()};
}

}  // namespace

const Kernels kNeonKernels = {
    "neon", project<false>, project_lens<false>, project<true>, project_lens<true>, correlate,
    vote,   compare};

}  // namespace gannet::vision
