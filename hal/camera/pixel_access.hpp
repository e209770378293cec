// Reads single pixels of any ImageView, and converts between colour spaces: the scalar truth that
// tests, model building and pictures use. Frames are prepared with tables and SIMD elsewhere and
// compared with this. Header only, so that rooms without hal's code can use it. RT safe.
//
// Source: ITU-R BT.601-7 §2.5, BT.709-6 §3 (luma coefficients, 8-bit limited range: Y 16 … 235,
// chroma 16 … 240), JFIF 1.02 (full-range BT.601). With Kr, Kb and Kg = 1 − Kr − Kb:
//   Y = Kr R + Kg G + Kb B,  U = (B − Y) / (2 (1 − Kb)),  V = (R − Y) / (2 (1 − Kr)).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/camera/image_view.hpp"

namespace gannet::hal {

struct YuvPixel {
  std::uint8_t y = 0;
  std::uint8_t u = 128;
  std::uint8_t v = 128;
  friend bool operator==(const YuvPixel&, const YuvPixel&) = default;
};

struct RgbPixel {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;
  friend bool operator==(const RgbPixel&, const RgbPixel&) = default;
};

// ---- colour
// --------------------------------------------------------------------------------------

struct LumaWeights {
  double red, blue;
};
constexpr LumaWeights luma_weights(ColourMatrix matrix) {
  return matrix == ColourMatrix::kBt601 ? LumaWeights{0.299, 0.114} : LumaWeights{0.2126, 0.0722};
}

// Rounds half up and clamps to a byte; no libm.
constexpr std::uint8_t to_byte(double x) {
  return x <= 0 ? 0 : x >= 255 ? 255 : static_cast<std::uint8_t>(x + 0.5);
}

// An affine map of three channels: out = m (in − in_offset) + out_offset.
struct ColourMap {
  std::array<double, 9> m = {};
  std::array<double, 3> in_offset = {};
  std::array<double, 3> out_offset = {};

  constexpr std::array<double, 3> operator()(double a, double b, double c) const {
    a -= in_offset[0], b -= in_offset[1], c -= in_offset[2];
    return {m[0] * a + m[1] * b + m[2] * c + out_offset[0],
            m[3] * a + m[4] * b + m[5] * c + out_offset[1],
            m[6] * a + m[7] * b + m[8] * c + out_offset[2]};
  }
};

// first, then second.
constexpr ColourMap chain(const ColourMap& second, const ColourMap& first) {
  ColourMap both;
  both.in_offset = first.in_offset;
  for (std::size_t i = 0; i < 3; ++i) {
    both.out_offset[i] = second.out_offset[i];
    for (std::size_t k = 0; k < 3; ++k) {
      both.out_offset[i] += second.m[3 * i + k] * (first.out_offset[k] - second.in_offset[k]);
      for (std::size_t j = 0; j < 3; ++j)
        both.m[3 * i + j] += second.m[3 * i + k] * first.m[3 * k + j];
    }
  }
  return both;
}

// YUV codes 0 … 255 → R, G, B 0 … 255, not clamped.
constexpr ColourMap rgb_from_yuv(ColourMatrix matrix, ColourRange range) {
  const auto [kr, kb] = luma_weights(matrix);
  const double kg = 1 - kr - kb;
  const bool limited = range == ColourRange::kLimited;
  const double luma = limited ? 255.0 / 219 : 1;
  const double chroma = limited ? 255.0 / 224 : 1;
  const double red_v = 2 * (1 - kr) * chroma;
  const double blue_u = 2 * (1 - kb) * chroma;
  return {{luma, 0, red_v,                             //
           luma, -blue_u * kb / kg, -red_v * kr / kg,  //
           luma, blue_u, 0},
          {limited ? 16.0 : 0.0, 128, 128},
          {0, 0, 0}};
}

// R, G, B 0 … 255 → YUV codes, not clamped.
constexpr ColourMap yuv_from_rgb(ColourMatrix matrix, ColourRange range) {
  const auto [kr, kb] = luma_weights(matrix);
  const double kg = 1 - kr - kb;
  const bool limited = range == ColourRange::kLimited;
  const double luma = limited ? 219.0 / 255 : 1;
  const double u = (limited ? 224.0 / 255 : 1) / (2 * (1 - kb));
  const double v = (limited ? 224.0 / 255 : 1) / (2 * (1 - kr));
  return {{luma * kr, luma * kg, luma * kb,  //
           -u * kr, -u * kg, u * (1 - kb),   //
           v * (1 - kr), -v * kg, -v * kb},
          {0, 0, 0},
          {limited ? 16.0 : 0.0, 128, 128}};
}

// What is stored in a view of this kind → full-range BT.601 codes, not clamped.
constexpr ColourMap full_bt601_from(PixelFormat format, ColourMatrix matrix, ColourRange range) {
  const ColourMap target = yuv_from_rgb(ColourMatrix::kBt601, ColourRange::kFull);
  return format == PixelFormat::kRgb24 ? target : chain(target, rgb_from_yuv(matrix, range));
}

constexpr YuvPixel to_yuv(const ColourMap& map, double a, double b, double c) {
  const auto [y, u, v] = map(a, b, c);
  return {to_byte(y), to_byte(u), to_byte(v)};
}

constexpr RgbPixel to_rgb(const ColourMap& map, double a, double b, double c) {
  const auto [red, green, blue] = map(a, b, c);
  return {to_byte(red), to_byte(green), to_byte(blue)};
}

// ---- pixels
// --------------------------------------------------------------------------------------

// The three stored codes of a pixel: Y, U, V by the view's matrix and range, or R, G, B. x, y must
// be inside. Subsampled chroma is that of the cell the pixel lies in.
inline std::array<std::uint8_t, 3> stored_at(const ImageView& view, int x, int y) {
  const auto row = [&](std::size_t plane, int at) {
    return view.plane[plane] + std::ptrdiff_t{at} * view.stride[plane];
  };
  switch (view.format) {
    case PixelFormat::kYuyv: {
      const std::uint8_t* pair = row(0, y) + 4 * (x / 2);
      return {pair[2 * (x % 2)], pair[1], pair[3]};
    }
    case PixelFormat::kUyvy: {
      const std::uint8_t* pair = row(0, y) + 4 * (x / 2);
      return {pair[2 * (x % 2) + 1], pair[0], pair[2]};
    }
    case PixelFormat::kNv12: {
      const std::uint8_t* chroma = row(1, y / 2) + 2 * (x / 2);
      return {row(0, y)[x], chroma[0], chroma[1]};
    }
    case PixelFormat::kYuv422:
      return {row(0, y)[x], row(1, y)[x / 2], row(2, y)[x / 2]};
    case PixelFormat::kYuv420:
      return {row(0, y)[x], row(1, y / 2)[x / 2], row(2, y / 2)[x / 2]};
    case PixelFormat::kYuv444:
      return {row(0, y)[x], row(1, y)[x], row(2, y)[x]};
    case PixelFormat::kRgb24: {
      const std::uint8_t* pixel = row(0, y) + 3 * x;
      return {pixel[0], pixel[1], pixel[2]};
    }
  }
  return {0, 128, 128};
}

// A pixel as full-range BT.601. For many pixels make the map once and use to_yuv.
inline YuvPixel yuv_at(const ImageView& view, int x, int y) {
  const auto [a, b, c] = stored_at(view, x, y);
  return to_yuv(full_bt601_from(view.format, view.matrix, view.range), a, b, c);
}

inline RgbPixel rgb_at(const ImageView& view, int x, int y) {
  const auto [a, b, c] = stored_at(view, x, y);
  if (view.format == PixelFormat::kRgb24) return {a, b, c};
  return to_rgb(rgb_from_yuv(view.matrix, view.range), a, b, c);
}

}  // namespace gannet::hal
