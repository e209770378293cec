// Kernels: the inner loops of recognition, one table of functions per instruction set. Every table
// gives the same bits: sums are integers, addresses come from the same unfused float operations in
// the same order with true division, range checks are made on the floats
// (docs/design/same-bits.md). `scalar` is the truth; the others are variants of it. RT safe.
//
// Arrays of points are padded to a multiple of kLanes with NaN coordinates: a NaN fails every range
// check, so padding lands on the guard cell like any point outside the image.
#pragma once

#include <cstdint>

namespace gannet::vision {

constexpr int kLanes = 16;  // points; padding of every point array
constexpr int padded(int n) { return (n + kLanes - 1) / kLanes * kLanes; }

// One camera's view of a plane: (u, v, w) = h · (x, y, 1), behind a flat port + √e(x, y) · port.
// Without a lens table u/w and v/w are pixels; with one they are normalised coordinates that the
// lens then moves.
struct PlaneView {
  float h[9];
  int width;  // pixels of the plane that is sampled
  int height;
  int stride;  // cells from one row to the next
  int guard;   // index of the cell that stands for "outside the image"
  // e = (e₀x + e₁y + e₂)x + (e₃y + e₄)y + e₅; NaN: nothing can be seen.
  float e[6] = {};
  float port[3] = {};  // of u, v, w
};

// Distortion as a radial factor over r² with linear interpolation, plus the tangential terms.
// (Kannala–Brandt's arctangent would tie the bits to one libm; a table ties them to itself.)
struct LensTable {
  static constexpr int kSteps = 1024;
  float factor[kSteps + 2];  // at r² = i / scale
  float scale;               // steps per unit of r²
  float r2_max;              // beyond it a point is outside
  float p1, p2;              // Brown's tangential coefficients
  float fx, fy, cx, cy;      // of the sampled plane, pixels
};

// Integer sums of one image's cells against a model, per channel Y U V.
struct CorrelationSums {
  std::int32_t i[3];
  std::int32_t ii[3];
  std::int32_t im[3];
  std::int32_t m[3];  // over the visible points only
  std::int32_t mm[3];
};

// Votes of P001 Eq. 4–6 / P002 Eq. 4–6, counted as classes.
struct VoteCounts {
  std::int32_t in_match;           // S_in, image ~ model
  std::int32_t in_far;             // S_in, image vs model >= 50 degrees (P001)
  std::int32_t in_background;      // S_in, neither of the two (P002: not match), background ~ model
  std::int32_t in_far_background;  // S_in, far and background ~ model: P002 counts them
  std::int32_t out_background;     // S_out, background ~ image
  std::int32_t out_other;          // S_out, the rest
};

// Votes of P000 Eq. 1–9 / P004 Eq. 2–8.
struct ProjectionCounts {
  std::int32_t hue_match;
  std::int32_t hue_other;
  std::int32_t value_match;
  std::int32_t value_other;
};

// Hue distances in 256 steps a circle (method: <= 30, <= 20, >= 50 degrees).
constexpr int kHueNear30 = 21;
constexpr int kHueNear20 = 14;
constexpr int kHueFar50 = 36;
constexpr int kValueNear = 20;  // grey levels

struct Kernels {
  const char* name;

  // index[i] = cell that shows point i, or the guard. n is padded. Returns the points inside.
  int (*project)(const float* x, const float* y, int n, const PlaneView& view, std::int32_t* index);
  int (*project_lens)(const float* x, const float* y, int n, const PlaneView& view,
                      const LensTable& lens, std::int32_t* index);
  // The same behind a flat port.
  int (*project_port)(const float* x, const float* y, int n, const PlaneView& view,
                      std::int32_t* index);
  int (*project_port_lens)(const float* x, const float* y, int n, const PlaneView& view,
                           const LensTable& lens, std::int32_t* index);

  // cells: bytes Y U V (0 … 127) and 1; the guard is four zeros. model: blocks of four points, 16
  // bytes [Y×4 U×4 V×4 0×4], −64 … 63, 0 for padding. all_visible skips m and mm.
  void (*correlate)(const std::uint32_t* cells, const std::int32_t* index, int n,
                    const std::int8_t* model, bool all_visible, CorrelationSums& sums);

  // cells: low byte hue, high byte value. flags: 0xFF where background ~ model. The first n_in
  // points (padded) are S_in with their hues, then n_out (padded) S_out.
  void (*vote)(const std::uint16_t* cells, const std::int32_t* index, int n_in, int n_out,
               int guard, const std::uint8_t* hue, const std::uint8_t* flags,
               std::uint8_t background_hue, VoteCounts& counts);

  // hue_value: model cells as 16 bits; counts over n (padded) points.
  void (*compare)(const std::uint16_t* cells, const std::int32_t* index, int n, int guard,
                  const std::uint16_t* hue_value, ProjectionCounts& counts);
};

extern const Kernels kScalarKernels;
extern const Kernels kAvx2Kernels;    // x86-64 only
extern const Kernels kAvx512Kernels;  // x86-64 only; F, BW, VL, VNNI
extern const Kernels kNeonKernels;    // aarch64 only

}  // namespace gannet::vision
