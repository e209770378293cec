// AVX-512 with VNNI: sixteen points a step. Same bits as kernels_scalar.cpp: no fused operations,
// true division. The comparisons give bit masks, so that votes are counted by counting bits.
#include <immintrin.h>

#include "src/vision/kernels/kernels.hpp"

namespace gannet::vision {
namespace {

inline int count_of(__mmask16 mask) { return __builtin_popcount(mask); }

template <bool kPort>
struct View16 {
  __m512 h[9];
  __m512 e[6], port[3];
  __m512 width, height;
  __m512i stride, guard;

  explicit View16(const PlaneView& view)
      : width(_mm512_set1_ps(static_cast<float>(view.width))),
        height(_mm512_set1_ps(static_cast<float>(view.height))),
        stride(_mm512_set1_epi32(view.stride)),
        guard(_mm512_set1_epi32(view.guard)) {
    for (int k = 0; k < 9; ++k) h[k] = _mm512_set1_ps(view.h[k]);
    if constexpr (kPort) {
      for (int k = 0; k < 6; ++k) e[k] = _mm512_set1_ps(view.e[k]);
      for (int k = 0; k < 3; ++k) port[k] = _mm512_set1_ps(view.port[k]);
    }
  }

  static __m512 row_of(const __m512* c, __m512 x, __m512 y) {
    return _mm512_add_ps(_mm512_add_ps(_mm512_mul_ps(c[0], x), _mm512_mul_ps(c[1], y)), c[2]);
  }

  // Where sixteen points of the plane are seen: u and v over w.
  void see(__m512 x, __m512 y, __m512& u, __m512& v, __m512& w) const {
    w = row_of(h + 6, x, y);
    u = row_of(h, x, y);
    v = row_of(h + 3, x, y);
    if constexpr (kPort) {
      const __m512 by_x = _mm512_mul_ps(row_of(e, x, y), x);
      const __m512 by_y = _mm512_mul_ps(_mm512_add_ps(_mm512_mul_ps(e[3], y), e[4]), y);
      const __m512 r = _mm512_sqrt_ps(_mm512_add_ps(by_x, _mm512_add_ps(by_y, e[5])));
      u = _mm512_add_ps(u, _mm512_mul_ps(r, port[0]));
      v = _mm512_add_ps(v, _mm512_mul_ps(r, port[1]));
      w = _mm512_add_ps(w, _mm512_mul_ps(r, port[2]));
    }
    u = _mm512_div_ps(u, w);
    v = _mm512_div_ps(v, w);
  }

  // Cells of sixteen pixel positions; inside: which of the valid points have one.
  __m512i cells(__m512 u, __m512 v, __m512 w, __mmask16 valid, __mmask16& inside) const {
    const __m512 half = _mm512_set1_ps(0.5f);
    const __m512 zero = _mm512_setzero_ps();
    const __m512 column = _mm512_add_ps(u, half);
    const __m512 line = _mm512_add_ps(v, half);
    __mmask16 ok = _mm512_mask_cmp_ps_mask(valid, w, zero, _CMP_GT_OQ);
    ok = _mm512_mask_cmp_ps_mask(ok, column, zero, _CMP_GE_OQ);
    ok = _mm512_mask_cmp_ps_mask(ok, column, width, _CMP_LT_OQ);
    ok = _mm512_mask_cmp_ps_mask(ok, line, zero, _CMP_GE_OQ);
    inside = _mm512_mask_cmp_ps_mask(ok, line, height, _CMP_LT_OQ);
    const __m512i row = _mm512_mullo_epi32(_mm512_cvttps_epi32(line), stride);
    return _mm512_mask_add_epi32(guard, inside, row, _mm512_cvttps_epi32(column));
  }
};

template <bool kPort>
int project(const float* x, const float* y, int n, const PlaneView& view, std::int32_t* index) {
  const View16<kPort> v16(view);
  constexpr __mmask16 kAll = 0xFFFF;
  int count = 0;
  for (int i = 0; i < n; i += 16) {
    __m512 u, v, w;
    v16.see(_mm512_loadu_ps(x + i), _mm512_loadu_ps(y + i), u, v, w);
    __mmask16 inside;
    _mm512_storeu_si512(index + i, v16.cells(u, v, w, kAll, inside));
    count += count_of(inside);
  }
  return count;
}

template <bool kPort>
int project_lens(const float* x, const float* y, int n, const PlaneView& view,
                 const LensTable& lens, std::int32_t* index) {
  const View16<kPort> v16(view);
  const __m512 r2_max = _mm512_set1_ps(lens.r2_max);
  const __m512 scale = _mm512_set1_ps(lens.scale);
  const __m512 p1 = _mm512_set1_ps(lens.p1);
  const __m512 p2 = _mm512_set1_ps(lens.p2);
  const __m512 two = _mm512_set1_ps(2.0f);
  int count = 0;
  for (int i = 0; i < n; i += 16) {
    __m512 a, b, w;
    v16.see(_mm512_loadu_ps(x + i), _mm512_loadu_ps(y + i), a, b, w);
    const __m512 aa = _mm512_mul_ps(a, a);
    const __m512 bb = _mm512_mul_ps(b, b);
    const __m512 r2 = _mm512_add_ps(aa, bb);
    const __mmask16 valid = _mm512_cmp_ps_mask(r2, r2_max, _CMP_LE_OQ);
    const __m512 s = _mm512_maskz_mul_ps(valid, r2, scale);
    const __m512i step = _mm512_cvttps_epi32(s);
    const __m512 low = _mm512_i32gather_ps(step, lens.factor, 4);
    const __m512 high = _mm512_i32gather_ps(step, lens.factor + 1, 4);
    const __m512 factor = _mm512_add_ps(
        low, _mm512_mul_ps(_mm512_sub_ps(high, low), _mm512_sub_ps(s, _mm512_cvtepi32_ps(step))));
    const __m512 ab2 = _mm512_mul_ps(two, _mm512_mul_ps(a, b));
    const __m512 da = _mm512_add_ps(_mm512_mul_ps(p1, ab2),
                                    _mm512_mul_ps(p2, _mm512_add_ps(r2, _mm512_mul_ps(two, aa))));
    const __m512 db = _mm512_add_ps(_mm512_mul_ps(p1, _mm512_add_ps(r2, _mm512_mul_ps(two, bb))),
                                    _mm512_mul_ps(p2, ab2));
    const __m512 u = _mm512_add_ps(
        _mm512_mul_ps(_mm512_set1_ps(lens.fx), _mm512_add_ps(_mm512_mul_ps(a, factor), da)),
        _mm512_set1_ps(lens.cx));
    const __m512 v = _mm512_add_ps(
        _mm512_mul_ps(_mm512_set1_ps(lens.fy), _mm512_add_ps(_mm512_mul_ps(b, factor), db)),
        _mm512_set1_ps(lens.cy));
    __mmask16 inside;
    _mm512_storeu_si512(index + i, v16.cells(u, v, w, valid, inside));
    count += count_of(inside);
  }
  return count;
}

inline void store_channels(__m512i total, std::int32_t* out) {
  alignas(16) std::int32_t lanes[4];
  const __m256i halves =
      _mm256_add_epi32(_mm512_castsi512_si256(total), _mm512_extracti64x4_epi64(total, 1));
  const __m128i sum =
      _mm_add_epi32(_mm256_castsi256_si128(halves), _mm256_extracti128_si256(halves, 1));
  _mm_store_si128(reinterpret_cast<__m128i*>(lanes), sum);
  for (int c = 0; c < 3; ++c) out[c] = lanes[c];
}

template <bool kAllVisible>
void correlate_cells(const std::uint32_t* cells, const std::int32_t* index, int n,
                     const std::int8_t* model, CorrelationSums& sums) {
  // Four cells YUV1 YUV1 YUV1 YUV1 become YYYY UUUU VVVV 1111, whose products with four others are
  // added into the 32-bit lanes [Y U V -].
  const __m512i by_channel =
      _mm512_broadcast_i32x4(_mm_setr_epi8(0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15));
  const __m512i visible_of = _mm512_broadcast_i32x4(
      _mm_setr_epi8(12, 13, 14, 15, 12, 13, 14, 15, 12, 13, 14, 15, 12, 13, 14, 15));
  const __m512i ones = _mm512_set1_epi8(1);
  __m512i i1 = _mm512_setzero_si512(), ii = i1, im = i1, m1 = i1, mm = i1;
  for (int i = 0; i < n; i += 16) {
    const __m512i at = _mm512_loadu_si512(index + i);
    const __m512i pixel = _mm512_shuffle_epi8(_mm512_i32gather_epi32(at, cells, 4), by_channel);
    const __m512i expected = _mm512_loadu_si512(model + 4 * i);
    i1 = _mm512_dpbusd_epi32(i1, pixel, ones);
    ii = _mm512_dpbusd_epi32(ii, pixel, pixel);  // 7 bits: also as signed ones
    im = _mm512_dpbusd_epi32(im, pixel, expected);
    if constexpr (!kAllVisible) {
      const __mmask64 visible = _mm512_test_epi8_mask(_mm512_shuffle_epi8(pixel, visible_of), ones);
      const __m512i seen = _mm512_maskz_mov_epi8(visible, expected);
      const __m512i size = _mm512_abs_epi8(seen);
      m1 = _mm512_dpbusd_epi32(m1, ones, seen);
      mm = _mm512_dpbusd_epi32(mm, size, size);
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

inline __m512i circular_distance(__m512i a, __m512i b) {
  const __m512i d = _mm512_abs_epi32(_mm512_sub_epi32(a, b));
  return _mm512_min_epi32(d, _mm512_sub_epi32(_mm512_set1_epi32(256), d));
}

inline __m512i load_bytes(const std::uint8_t* bytes) {
  return _mm512_cvtepu8_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(bytes)));
}

// Reads 32 bits at a 16-bit cell: the plane has a cell to spare behind the guard.
inline __m512i gather_cells(const std::uint16_t* cells, __m512i at) {
  return _mm512_i32gather_epi32(at, cells, 2);
}

inline __mmask16 not_above(__mmask16 of, __m512i value, int limit) {
  return _mm512_mask_cmple_epi32_mask(of, value, _mm512_set1_epi32(limit));
}

void vote(const std::uint16_t* cells, const std::int32_t* index, int n_in, int n_out, int guard,
          const std::uint8_t* hue, const std::uint8_t* flags, std::uint8_t background_hue,
          VoteCounts& counts) {
  const __m512i outside = _mm512_set1_epi32(guard);
  const __m512i hue_mask = _mm512_set1_epi32(0xFF);
  counts = {};
  for (int i = 0; i < n_in; i += 16) {
    const __m512i at = _mm512_loadu_si512(index + i);
    const __mmask16 shown = _mm512_cmpneq_epi32_mask(at, outside);
    const __m512i seen = _mm512_and_si512(gather_cells(cells, at), hue_mask);
    const __m512i d = circular_distance(seen, load_bytes(hue + i));
    const __mmask16 match = not_above(shown, d, kHueNear30);
    const __mmask16 far = _mm512_mask_cmpge_epi32_mask(shown, d, _mm512_set1_epi32(kHueFar50));
    const __m128i flag = _mm_loadu_si128(reinterpret_cast<const __m128i*>(flags + i));
    const __mmask16 flagged = _mm_test_epi8_mask(flag, flag);
    counts.in_match += count_of(match);
    counts.in_far += count_of(far);
    counts.in_background += count_of(static_cast<__mmask16>(shown & ~match & ~far & flagged));
    counts.in_far_background += count_of(static_cast<__mmask16>(far & flagged));
  }
  const __m512i bg = _mm512_set1_epi32(background_hue);
  for (int i = n_in; i < n_in + n_out; i += 16) {
    const __m512i at = _mm512_loadu_si512(index + i);
    const __mmask16 shown = _mm512_cmpneq_epi32_mask(at, outside);
    const __m512i seen = _mm512_and_si512(gather_cells(cells, at), hue_mask);
    const __mmask16 near = not_above(shown, circular_distance(seen, bg), kHueNear20);
    counts.out_background += count_of(near);
    counts.out_other += count_of(static_cast<__mmask16>(shown & ~near));
  }
}

void compare(const std::uint16_t* cells, const std::int32_t* index, int n, int guard,
             const std::uint16_t* hue_value, ProjectionCounts& counts) {
  const __m512i outside = _mm512_set1_epi32(guard);
  const __m512i low = _mm512_set1_epi32(0xFF);
  const __m512i cell = _mm512_set1_epi32(0xFFFF);
  int hue_match = 0, value_match = 0, visible = 0;
  for (int i = 0; i < n; i += 16) {
    const __m512i at = _mm512_loadu_si512(index + i);
    const __mmask16 shown = _mm512_cmpneq_epi32_mask(at, outside);
    const __m512i seen = _mm512_and_si512(gather_cells(cells, at), cell);
    const __m512i expected =
        _mm512_cvtepu16_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(hue_value + i)));
    const __m512i hue =
        circular_distance(_mm512_and_si512(seen, low), _mm512_and_si512(expected, low));
    const __m512i value = _mm512_abs_epi32(
        _mm512_sub_epi32(_mm512_srli_epi32(seen, 8), _mm512_srli_epi32(expected, 8)));
    visible += count_of(shown);
    hue_match += count_of(not_above(shown, hue, kHueNear20));
    value_match += count_of(not_above(shown, value, kValueNear));
  }
  counts = {hue_match, visible - hue_match, value_match, visible - value_match};
}

}  // namespace

const Kernels kAvx512Kernels = {
    "avx512", project<false>, project_lens<false>, project<true>, project_lens<true>, correlate,
    vote,     compare};

}  // namespace gannet::vision
