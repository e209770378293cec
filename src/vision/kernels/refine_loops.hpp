// The loops of refine_sums.hpp, included by each refine_*.cpp and compiled there for its
// instruction set; everything has internal linkage. Vectors are the compiler's own, eight floats
// wide whatever the registers are: unfused operations and true division in one order. RT safe.
#pragma once

#include <cstring>

#include "src/vision/kernels/refine_sums.hpp"

// Vectors never leave these functions, so no call depends on how they would be passed.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace gannet::vision {
namespace {

using Floats = float __attribute__((vector_size(32)));
using Ints = std::int32_t __attribute__((vector_size(32)));
using Words = std::uint32_t __attribute__((vector_size(32)));

inline __attribute__((always_inline)) Floats all(float x) { return Floats{} + x; }
inline __attribute__((always_inline)) Floats load(const float* from) {
  Floats out;
  std::memcpy(&out, from, sizeof out);
  return out;
}
// a where the mask is set, else 0.
inline __attribute__((always_inline)) Floats only(const Ints& mask, const Floats& a) {
  return reinterpret_cast<Floats>(mask & reinterpret_cast<Ints>(a));
}
inline __attribute__((always_inline)) Floats choose(const Ints& mask, const Floats& a,
                                                    const Floats& b) {
  return reinterpret_cast<Floats>((mask & reinterpret_cast<Ints>(a)) |
                                  (~mask & reinterpret_cast<Ints>(b)));
}
inline __attribute__((always_inline)) Floats byte_of(const Words& words, int k) {
  return __builtin_convertvector(reinterpret_cast<Ints>(words >> (8 * k) & 255u), Floats);
}
inline __attribute__((always_inline)) void add(float* sum, const Floats& a) {
  const Floats total = load(sum) + a;
  std::memcpy(sum, &total, sizeof total);
}

// Eight points as an eye sees them.
struct Seen {
  Floats u, v;           // pixels
  Floats weight;         // 0 where there is none
  Floats slopes[2][3];   // of the pixel by the point in the left camera's axes
  Floats point[3];       // in the left camera's axes: the lever arm, or the ray
  Floats inverse_depth;  // unscaled targets
};

template <int kParameters>
inline __attribute__((always_inline)) void see(const RefineEye& eye, const RefinePart& part, int i,
                                               Seen& out) {
  const Floats x = load(part.x + i), y = load(part.y + i);
  const float* const h = eye.h;
  Floats camera[3];
  Floats scale = all(1.0f);
  for (int k = 0; k < 3; ++k) camera[k] = (x * h[3 * k] + y * h[3 * k + 1]) + h[3 * k + 2];
  const bool flat = part.z == nullptr;
  const Floats z = flat ? all(0.0f) : load(part.z + i);
  if (kParameters == 6 && !flat) {
    for (int k = 0; k < 3; ++k) camera[k] = camera[k] + z * eye.deep[k];
  }
  if constexpr (kParameters == 3) {
    // Of a ray m: p = m / (plane · m); h holds the eye's rotation, its translation is in arm.
    out.inverse_depth = (x * eye.plane[0] + y * eye.plane[1]) + eye.plane[2];
    scale = 1.0f / out.inverse_depth;
    for (int k = 0; k < 3; ++k) camera[k] = camera[k] * scale + eye.arm[k];
  }
  const Floats inverse = 1.0f / camera[2];
  const Floats a = camera[0] * inverse, b = camera[1] * inverse;
  Floats by_a[2] = {all(eye.fx), all(0.0f)}, by_b[2] = {all(0.0f), all(eye.fy)};
  if (part.lens == nullptr) {
    out.u = a * eye.fx + eye.cx;
    out.v = b * eye.fy + eye.cy;
  } else {
    out.u = load(part.lens->u + i);
    out.v = load(part.lens->v + i);
    by_a[0] = load(part.lens->slopes[0] + i);
    by_b[0] = load(part.lens->slopes[1] + i);
    by_a[1] = load(part.lens->slopes[2] + i);
    by_b[1] = load(part.lens->slopes[3] + i);
  }
  // One pixel of margin for the gradients. A NaN fails every comparison.
  const Ints ok = (camera[2] > 1e-6f) & (scale > 0.0f) & (out.u >= 1.0f) & (out.v >= 1.0f) &
                  (out.u < static_cast<float>(eye.width - 2)) &
                  (out.v < static_cast<float>(eye.height - 2));
  out.weight = only(ok, all(part.weight));
  out.u = choose(ok, out.u, all(1.0f));
  out.v = choose(ok, out.v, all(1.0f));
  out.inverse_depth = choose(ok, out.inverse_depth, all(1.0f));
  const float* const r = eye.turn;
  for (int row = 0; row < 2; ++row) {
    const Floats q0 = only(ok, by_a[row] * inverse), q1 = only(ok, by_b[row] * inverse);
    const Floats q2 = only(ok, 0.0f - (by_a[row] * a + by_b[row] * b) * inverse);
    for (int k = 0; k < 3; ++k) {
      out.slopes[row][k] = (q0 * r[3 * k] + q1 * r[3 * k + 1]) + q2 * r[3 * k + 2];
    }
  }
  if constexpr (kParameters == 3) {
    out.point[0] = only(ok, x);
    out.point[1] = only(ok, y);
    out.point[2] = only(ok, all(1.0f));
  } else {
    for (int k = 0; k < 3; ++k) {
      Floats arm = x * eye.arm[k] + y * eye.arm[3 + k];
      if (!flat) arm = arm + z * eye.arm[6 + k];
      out.point[k] = only(ok, arm);
    }
  }
}

// Bilinear value and central differences, bilinear too, of a smoothed plane.
struct Sampled {
  Floats value, by_u, by_v;
};

inline __attribute__((always_inline)) Sampled sample(const std::uint8_t* plane, int width,
                                                     const std::int32_t* offset, const Floats& p,
                                                     const Floats& q) {
  Floats at[4][4];
  for (int row = 0; row < 4; ++row) {
    std::uint32_t words[kSumLanes];
    for (int k = 0; k < kSumLanes; ++k) {
      std::memcpy(&words[k], plane + offset[k] + (row - 1) * width - 1, 4);
    }
    Words four;
    std::memcpy(&four, words, sizeof four);
    for (int k = 0; k < 4; ++k) at[row][k] = byte_of(four, k);
  }
  const auto mix = [&](const Floats& a, const Floats& b, const Floats& c, const Floats& d)
      __attribute__((always_inline)) {
    const Floats top = a + p * (b - a), bottom = c + p * (d - c);
    return top + q * (bottom - top);
  };
  Sampled out;
  out.value = mix(at[1][1], at[1][2], at[2][1], at[2][2]);
  out.by_u = 0.5f * mix(at[1][2] - at[1][0], at[1][3] - at[1][1], at[2][2] - at[2][0],
                        at[2][3] - at[2][1]);
  out.by_v = 0.5f * mix(at[2][1] - at[0][1], at[2][2] - at[0][2], at[3][1] - at[1][1],
                        at[3][2] - at[1][2]);
  return out;
}

template <int kParameters>
inline __attribute__((always_inline)) void slopes_of(const Seen& seen, const Sampled& image,
                                                     Floats* j) {
  Floats s[3];
  for (int k = 0; k < 3; ++k)
    s[k] = image.by_u * seen.slopes[0][k] + image.by_v * seen.slopes[1][k];
  const Floats* const p = seen.point;
  if constexpr (kParameters == 3) {
    // p = m / d: by the plane it is −m mᵀ / d².
    const Floats along = (p[0] * s[0] + p[1] * s[1]) + p[2] * s[2];
    const Floats scale = 0.0f - along / (seen.inverse_depth * seen.inverse_depth);
    for (int k = 0; k < 3; ++k) j[k] = scale * p[k];
  } else {
    for (int k = 0; k < 3; ++k) j[k] = s[k];
    j[3] = p[1] * s[2] - p[2] * s[1];
    j[4] = p[2] * s[0] - p[0] * s[2];
    j[5] = p[0] * s[1] - p[1] * s[0];
  }
}

template <int kParameters>
void add_part(const RefineEye& eye, const RefinePart& part, RefineSums<kParameters>& sums) {
  for (int i = 0; i < part.n; i += kSumLanes) {
    Seen seen;
    see<kParameters>(eye, part, i, seen);
    const Ints column = __builtin_convertvector(seen.u, Ints);
    const Ints row = __builtin_convertvector(seen.v, Ints);
    const Floats p = seen.u - __builtin_convertvector(column, Floats);
    const Floats q = seen.v - __builtin_convertvector(row, Floats);
    std::int32_t offset[kSumLanes];
    const Ints offsets = row * eye.width + column;
    std::memcpy(offset, &offsets, sizeof offset);
    for (int c = 0; c < 3; ++c) {
      const Sampled image = sample(eye.smooth[c], eye.width, offset, p, q);
      float models[kSumLanes];
      for (int k = 0; k < kSumLanes; ++k) models[k] = part.colour[3 * (i + k) + c];
      const Floats model = load(models) - 128.0f, value = image.value - 128.0f;
      const ChannelFit& fit = eye.fit[c];
      const Floats residual = value - model * fit.gain - fit.offset;
      const Floats weight = seen.weight / (1.0f + residual * residual * fit.weight_scale);
      const Floats wm = weight * model, wi = weight * value;
      float(*const to)[kSumLanes] = sums.lanes[c];
      add(to[0], weight);
      add(to[1], wm);
      add(to[2], wm * model);
      add(to[3], wi);
      add(to[4], wi * model);
      add(to[5], wi * value);
      Floats j[kParameters];
      slopes_of<kParameters>(seen, image, j);
      int at = 6 + 3 * kParameters;
      for (int k = 0; k < kParameters; ++k) {
        const Floats wj = weight * j[k];
        add(to[6 + k], wj);
        add(to[6 + kParameters + k], wm * j[k]);
        add(to[6 + 2 * kParameters + k], wi * j[k]);
        for (int l = k; l < kParameters; ++l) add(to[at++], wj * j[l]);
      }
    }
  }
}

}  // namespace
}  // namespace gannet::vision
