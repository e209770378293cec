// Hue and value of HSV straight from full-range BT.601 YUV. Away from clipping R−Y, G−Y and B−Y are
// linear in (U, V) alone, so hue is a function of (U, V) and value is Y plus one: two tables and no
// RGB in between. Hue has 256 steps a circle; a colour without chroma has hue 0. RT safe.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "src/vision/patch_model.hpp"

namespace gannet::vision {

class HueValueTable {
 public:
  HueValueTable();  // start-up only (fills 192 KiB)

  std::uint8_t hue(std::uint8_t u, std::uint8_t v) const { return hue_[at(u, v)]; }
  std::uint8_t value(std::uint8_t y, std::uint8_t u, std::uint8_t v) const {
    const int sum = y + rise_[at(u, v)];
    return static_cast<std::uint8_t>(sum > 255 ? 255 : sum);
  }
  // Low byte hue, high byte value.
  std::uint16_t cell(std::uint8_t y, std::uint8_t u, std::uint8_t v) const {
    return static_cast<std::uint16_t>(hue(u, v) | value(y, u, v) << 8);
  }

 private:
  static std::size_t at(std::uint8_t u, std::uint8_t v) {
    return static_cast<std::size_t>(u) << 8 | v;
  }
  std::array<std::uint8_t, 65536> hue_;
  std::array<std::uint8_t, 65536> rise_;  // max(R, G, B) − Y, never negative
};

// The one table of the process, made on first use (start-up).
const HueValueTable& hue_value_table();

std::uint16_t hue_value_of(const Yuv& colour);

// Distance on the circle of 256 steps, 0 … 128.
int hue_distance(int a, int b);

// Circular mean of the hues of these colours, each weighted by its chroma; 0 when there is none.
std::uint8_t mean_hue(std::span<const Yuv> colours);

}  // namespace gannet::vision
