#include "src/vision/hue_value.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace gannet::vision {
namespace {

struct RgbRise {
  double r, g, b;  // R − Y, G − Y, B − Y
};

RgbRise rise_of(double u, double v) { return {1.402 * v, -0.344136 * u - 0.714136 * v, 1.772 * u}; }

double hue_steps(const RgbRise& c) {
  const double high = std::max({c.r, c.g, c.b});
  const double chroma = high - std::min({c.r, c.g, c.b});
  if (chroma < 1e-9) return 0;
  double sextant = 0;
  if (high == c.r) {
    sextant = (c.g - c.b) / chroma;
  } else if (high == c.g) {
    sextant = (c.b - c.r) / chroma + 2;
  } else {
    sextant = (c.r - c.g) / chroma + 4;
  }
  return sextant * 256 / 6;
}

std::uint8_t to_byte(float x) {
  return static_cast<std::uint8_t>(std::clamp(std::lround(x), 0L, 255L));
}

}  // namespace

HueValueTable::HueValueTable() {
  for (int u = 0; u < 256; ++u) {
    for (int v = 0; v < 256; ++v) {
      const RgbRise c = rise_of(u - 128, v - 128);
      const std::size_t i = at(static_cast<std::uint8_t>(u), static_cast<std::uint8_t>(v));
      hue_[i] = static_cast<std::uint8_t>(std::lround(hue_steps(c)) & 255);
      rise_[i] =
          static_cast<std::uint8_t>(std::min(255L, std::lround(std::max({c.r, c.g, c.b, 0.0}))));
    }
  }
}

const HueValueTable& hue_value_table() {
  static const HueValueTable table;
  return table;
}

std::uint16_t hue_value_of(const Yuv& colour) {
  return hue_value_table().cell(to_byte(colour.y), to_byte(colour.u), to_byte(colour.v));
}

int hue_distance(int a, int b) {
  const int d = std::abs(a - b);
  return std::min(d, 256 - d);
}

std::uint8_t mean_hue(std::span<const Yuv> colours) {
  double sine = 0;
  double cosine = 0;
  for (const Yuv& c : colours) {
    const double chroma = std::hypot(c.u - 128, c.v - 128);
    const double angle = 2 * std::numbers::pi * hue_steps(rise_of(c.u - 128, c.v - 128)) / 256;
    sine += chroma * std::sin(angle);
    cosine += chroma * std::cos(angle);
  }
  if (std::hypot(sine, cosine) < 1e-6) return 0;
  return static_cast<std::uint8_t>(
      std::lround(std::atan2(sine, cosine) * 256 / (2 * std::numbers::pi)) & 255);
}

}  // namespace gannet::vision
