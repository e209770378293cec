// AVX2: eight points a step. Same bits as kernels_scalar.cpp: no fused operations, true division.
#include <immintrin.h>

#include "src/vision/kernels/kernels.hpp"

namespace gannet::vision {
namespace {

template <bool kPort>
struct View8 {
  __m256 h[9];
  __m256 e[6], port[3];
  __m256 width, height;
  __m256i stride, guard;

  explicit View8(const PlaneView& view)
      : width(_mm256_set1_ps(static_cast<float>(view.width))),
        height(_mm256_set1_ps(static_cast<float>(view.height))),
        stride(_mm256_set1_epi32(view.stride)),
        guard(_mm256_set1_epi32(view.guard)) {
    for (int k = 0; k < 9; ++k) h[k] = _mm256_set1_ps(view.h[k]);
    if constexpr (kPort) {
      for (int k = 0; k < 6; ++k) e[k] = _mm256_set1_ps(view.e[k]);
      for (int k = 0; k < 3; ++k) port[k] = _mm256_set1_ps(view.port[k]);
    }
  }

  static __m256 row_of(const __m256* c, __m256 x, __m256 y) {
    return _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(c[0], x), _mm256_mul_ps(c[1], y)), c[2]);
  }
  __m256 row(int k, __m256 x, __m256 y) const { return row_of(h + k, x, y); }

  // Where eight points of the plane are seen: u and v over w.
  void see(__m256 x, __m256 y, __m256& u, __m256& v, __m256& w) const {
    w = row(6, x, y);
    u = row(0, x, y);
    v = row(3, x, y);
    if constexpr (kPort) {
      const __m256 by_x = _mm256_mul_ps(row_of(e, x, y), x);
      const __m256 by_y = _mm256_mul_ps(_mm256_add_ps(_mm256_mul_ps(e[3], y), e[4]), y);
      const __m256 r = _mm256_sqrt_ps(_mm256_add_ps(by_x, _mm256_add_ps(by_y, e[5])));
      u = _mm256_add_ps(u, _mm256_mul_ps(r, port[0]));
      v = _mm256_add_ps(v, _mm256_mul_ps(r, port[1]));
      w = _mm256_add_ps(w, _mm256_mul_ps(r, port[2]));
    }
    u = _mm256_div_ps(u, w);
    v = _mm256_div_ps(v, w);
  }

  // Cells of eight pixel positions; inside gets a bit mask of the points that have one.
  __m256i cells(__m256 u, __m256 v, __m256 w, __m256 valid, int& inside) const {
    const __m256 half = _mm256_set1_ps(0.5f);
    const __m256 zero = _mm256_setzero_ps();
    const __m256 column = _mm256_add_ps(u, half);
    const __m256 line = _mm256_add_ps(v, half);
    __m256 ok = _mm256_and_ps(valid, _mm256_cmp_ps(w, zero, _CMP_GT_OQ));
    ok = _mm256_and_ps(ok, _mm256_cmp_ps(column, zero, _CMP_GE_OQ));
    ok = _mm256_and_ps(ok, _mm256_cmp_ps(column, width, _CMP_LT_OQ));
    ok = _mm256_and_ps(ok, _mm256_cmp_ps(line, zero, _CMP_GE_OQ));
    ok = _mm256_and_ps(ok, _mm256_cmp_ps(line, height, _CMP_LT_OQ));
    const __m256i cell = _mm256_add_epi32(_mm256_mullo_epi32(_mm256_cvttps_epi32(line), stride),
                                          _mm256_cvttps_epi32(column));
    inside = _mm256_movemask_ps(ok);
    return _mm256_blendv_epi8(guard, cell, _mm256_castps_si256(ok));
  }
};

template <bool kPort>
int project(const float* x, const float* y, int n, const PlaneView& view, std::int32_t* index) {
  const View8<kPort> v8(view);
  const __m256 all = _mm256_castsi256_ps(_mm256_set1_epi32(-1));
  int count = 0;
  for (int i = 0; i < n; i += 8) {
    const __m256 xs = _mm256_loadu_ps(x + i);
    const __m256 ys = _mm256_loadu_ps(y + i);
    __m256 u, v, w;
    v8.see(xs, ys, u, v, w);
    int inside = 0;
    const __m256i cells = v8.cells(u, v, w, all, inside);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(index + i), cells);
    count += __builtin_popcount(static_cast<unsigned>(inside));
  }
  return count;
}

template <bool kPort>
int project_lens(const float* x, const float* y, int n, const PlaneView& view,
                 const LensTable& lens, std::int32_t* index) {
  const View8<kPort> v8(view);
  const __m256 r2_max = _mm256_set1_ps(lens.r2_max);
  const __m256 scale = _mm256_set1_ps(lens.scale);
  const __m256 p1 = _mm256_set1_ps(lens.p1);
  const __m256 p2 = _mm256_set1_ps(lens.p2);
  const __m256 two = _mm256_set1_ps(2.0f);
  int count = 0;
  for (int i = 0; i < n; i += 8) {
    const __m256 xs = _mm256_loadu_ps(x + i);
    const __m256 ys = _mm256_loadu_ps(y + i);
    __m256 a, b, w;
    v8.see(xs, ys, a, b, w);
    const __m256 aa = _mm256_mul_ps(a, a);
    const __m256 bb = _mm256_mul_ps(b, b);
    const __m256 r2 = _mm256_add_ps(aa, bb);
    const __m256 valid = _mm256_cmp_ps(r2, r2_max, _CMP_LE_OQ);
    const __m256 s = _mm256_and_ps(valid, _mm256_mul_ps(r2, scale));
    const __m256i step = _mm256_cvttps_epi32(s);
    const __m256 low = _mm256_i32gather_ps(lens.factor, step, 4);
    const __m256 high = _mm256_i32gather_ps(lens.factor + 1, step, 4);
    const __m256 factor = _mm256_add_ps(
        low, _mm256_mul_ps(_mm256_sub_ps(high, low), _mm256_sub_ps(s, _mm256_cvtepi32_ps(step))));
    const __m256 ab2 = _mm256_mul_ps(two, _mm256_mul_ps(a, b));
    const __m256 da = _mm256_add_ps(_mm256_mul_ps(p1, ab2),
                                    _mm256_mul_ps(p2, _mm256_add_ps(r2, _mm256_mul_ps(two, aa))));
    const __m256 db = _mm256_add_ps(_mm256_mul_ps(p1, _mm256_add_ps(r2, _mm256_mul_ps(two, bb))),
                                    _mm256_mul_ps(p2, ab2));
    const __m256 u = _mm256_add_ps(
        _mm256_mul_ps(_mm256_set1_ps(lens.fx), _mm256_add_ps(_mm256_mul_ps(a, factor), da)),
        _mm256_set1_ps(lens.cx));
    const __m256 v = _mm256_add_ps(
        _mm256_mul_ps(_mm256_set1_ps(lens.fy), _mm256_add_ps(_mm256_mul_ps(b, factor), db)),
        _mm256_set1_ps(lens.cy));
    int inside = 0;
    const __m256i cells = v8.cells(u, v, w, valid, inside);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(index + i), cells);
    count += __builtin_popcount(static_cast<unsigned>(inside));
  }
  return count;
}

// Adds pairs of 16-bit sums into the 32-bit lanes [Y U V -] of both halves.
inline __m256i widen(__m256i total, __m256i pairs) {
  return _mm256_add_epi32(total, _mm256_madd_epi16(pairs, _mm256_set1_epi16(1)));
}

inline void store_channels(__m256i total, std::int32_t* out) {
  alignas(16) std::int32_t lanes[4];
  const __m128i sum =
      _mm_add_epi32(_mm256_castsi256_si128(total), _mm256_extracti128_si256(total, 1));
  _mm_store_si128(reinterpret_cast<__m128i*>(lanes), sum);
  for (int c = 0; c < 3; ++c) out[c] = lanes[c];
}

template <bool kAllVisible>
void correlate_cells(const std::uint32_t* cells, const std::int32_t* index, int n,
                     const std::int8_t* model, CorrelationSums& sums) {
  // Four cells YUV1 YUV1 YUV1 YUV1 become YYYY UUUU VVVV 1111.
  const __m256i by_channel = _mm256_broadcastsi128_si256(
      _mm_setr_epi8(0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15));
  const __m256i visible_of = _mm256_broadcastsi128_si256(
      _mm_setr_epi8(12, 13, 14, 15, 12, 13, 14, 15, 12, 13, 14, 15, 12, 13, 14, 15));
  const __m256i ones = _mm256_set1_epi8(1);
  __m256i i1 = _mm256_setzero_si256(), ii = i1, im = i1, m1 = i1, mm = i1;
  for (int i = 0; i < n; i += 8) {
    const __m256i at = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(index + i));
    const __m256i raw = _mm256_i32gather_epi32(reinterpret_cast<const int*>(cells), at, 4);
    const __m256i pixel = _mm256_shuffle_epi8(raw, by_channel);
    const __m256i expected = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(model + 4 * i));
    // 7-bit values: no sum of two products leaves 16 bits.
    i1 = widen(i1, _mm256_maddubs_epi16(pixel, ones));
    ii = widen(ii, _mm256_maddubs_epi16(pixel, pixel));
    im = widen(im, _mm256_maddubs_epi16(pixel, expected));
    if constexpr (!kAllVisible) {
      const __m256i visible = _mm256_shuffle_epi8(pixel, visible_of);
      const __m256i seen = _mm256_sign_epi8(expected, visible);
      const __m256i size = _mm256_abs_epi8(seen);
      m1 = widen(m1, _mm256_maddubs_epi16(ones, seen));
      mm = widen(mm, _mm256_maddubs_epi16(size, size));
    }
  }
  store_channels(i1, sums.i);
  store_channels(ii, sums.ii);
  store_channels(im, sums.im);
  store_channels(m1, sums.m);
  store_channels(mm, sums.mm);
}

void correlate(const std::uint32_t* cells, const std::int32_t* index, int n,
               const std::int8_t* model, bool all_visible, CorrelationSums& sums) {
  all_visible ? correlate_cells<true>(cells, index, n, model, sums)
              : correlate_cells<false>(cells, index, n, model, sums);
}

inline __m256i circular_distance(__m256i a, __m256i b) {
  const __m256i d = _mm256_abs_epi32(_mm256_sub_epi32(a, b));
  return _mm256_min_epi32(d, _mm256_sub_epi32(_mm256_set1_epi32(256), d));
}

inline __m256i load_bytes(const std::uint8_t* bytes) {
  return _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(bytes)));
}

// Reads 32 bits at a 16-bit cell: the plane has a cell to spare behind the guard.
inline __m256i gather_cells(const std::uint16_t* cells, __m256i at) {
  return _mm256_and_si256(_mm256_i32gather_epi32(reinterpret_cast<const int*>(cells), at, 2),
                          _mm256_set1_epi32(0xFFFF));
}

inline __m256i not_above(__m256i value, int limit) {
  return _mm256_cmpgt_epi32(_mm256_set1_epi32(limit + 1), value);
}

inline std::int32_t total(__m256i lanes) {
  alignas(32) std::int32_t v[8];
  _mm256_store_si256(reinterpret_cast<__m256i*>(v), lanes);
  return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
}

void vote(const std::uint16_t* cells, const std::int32_t* index, int n_in, int n_out, int guard,
          const std::uint8_t* hue, const std::uint8_t* flags, std::uint8_t background_hue,
          VoteCounts& counts) {
  const __m256i zero = _mm256_setzero_si256();
  const __m256i outside = _mm256_set1_epi32(guard);
  const __m256i hue_mask = _mm256_set1_epi32(0xFF);
  __m256i match = zero, far = zero, background = zero, far_background = zero;
  for (int i = 0; i < n_in; i += 8) {
    const __m256i at = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(index + i));
    const __m256i hidden = _mm256_cmpeq_epi32(at, outside);
    const __m256i seen = _mm256_and_si256(gather_cells(cells, at), hue_mask);
    const __m256i d = circular_distance(seen, load_bytes(hue + i));
    const __m256i is_match = _mm256_andnot_si256(hidden, not_above(d, kHueNear30));
    const __m256i is_far =
        _mm256_andnot_si256(hidden, _mm256_cmpgt_epi32(d, _mm256_set1_epi32(kHueFar50 - 1)));
    const __m256i flagged = _mm256_cmpgt_epi32(load_bytes(flags + i), zero);
    const __m256i taken = _mm256_or_si256(_mm256_or_si256(is_match, is_far), hidden);
    match = _mm256_sub_epi32(match, is_match);
    far = _mm256_sub_epi32(far, is_far);
    background = _mm256_sub_epi32(background, _mm256_andnot_si256(taken, flagged));
    far_background = _mm256_sub_epi32(far_background, _mm256_and_si256(is_far, flagged));
  }
  __m256i out_background = zero, out_other = zero;
  const __m256i bg = _mm256_set1_epi32(background_hue);
  for (int i = n_in; i < n_in + n_out; i += 8) {
    const __m256i at = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(index + i));
    const __m256i hidden = _mm256_cmpeq_epi32(at, outside);
    const __m256i seen = _mm256_and_si256(gather_cells(cells, at), hue_mask);
    const __m256i near = not_above(circular_distance(seen, bg), kHueNear20);
    out_background = _mm256_sub_epi32(out_background, _mm256_andnot_si256(hidden, near));
    out_other = _mm256_sub_epi32(
        out_other, _mm256_andnot_si256(_mm256_or_si256(hidden, near), _mm256_set1_epi32(-1)));
  }
  counts = {total(match),          total(far),      total(background), total(far_background),
            total(out_background), total(out_other)};
}

void compare(const std::uint16_t* cells, const std::int32_t* index, int n, int guard,
             const std::uint16_t* hue_value, ProjectionCounts& counts) {
  const __m256i zero = _mm256_setzero_si256();
  const __m256i outside = _mm256_set1_epi32(guard);
  const __m256i low = _mm256_set1_epi32(0xFF);
  __m256i hue_match = zero, value_match = zero, visible = zero;
  for (int i = 0; i < n; i += 8) {
    const __m256i at = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(index + i));
    const __m256i hidden = _mm256_cmpeq_epi32(at, outside);
    const __m256i seen = gather_cells(cells, at);
    const __m256i expected =
        _mm256_cvtepu16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(hue_value + i)));
    const __m256i hue =
        not_above(circular_distance(_mm256_and_si256(seen, low), _mm256_and_si256(expected, low)),
                  kHueNear20);
    const __m256i value =
        not_above(_mm256_abs_epi32(
                      _mm256_sub_epi32(_mm256_srli_epi32(seen, 8), _mm256_srli_epi32(expected, 8))),
                  kValueNear);
    visible = _mm256_sub_epi32(visible, _mm256_andnot_si256(hidden, _mm256_set1_epi32(-1)));
    hue_match = _mm256_sub_epi32(hue_match, _mm256_andnot_si256(hidden, hue));
    value_match = _mm256_sub_epi32(value_match, _mm256_andnot_si256(hidden, value));
  }
  const std::int32_t all = total(visible);
  counts.hue_match = total(hue_match);
  counts.hue_other = all - counts.hue_match;
  counts.value_match = total(value_match);
  counts.value_other = all - counts.value_match;
}

}  // namespace

const Kernels kAvx2Kernels = {
    "avx2", project<false>, project_lens<false>, project<true>, project_lens<true>, correlate,
    vote,   compare};

}  // namespace gannet::vision
