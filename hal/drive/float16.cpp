#include "hal/drive/float16.hpp"

#include <bit>

namespace gannet::hal {

std::uint16_t float16_from(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t sign = bits >> 16 & 0x8000;
  const std::uint32_t magnitude = bits & 0x7FFFFFFF;
  if (magnitude > 0x7F800000) return static_cast<std::uint16_t>(sign | 0x7E00);   // NaN
  if (magnitude >= 0x477FF000) return static_cast<std::uint16_t>(sign | 0x7C00);  // >= 65520
  std::uint32_t half;
  if (magnitude >= 0x38800000) {  // normal: 2^-14 and above
    const std::uint32_t rebiased = magnitude - (112u << 23);
    half = (rebiased + 0xFFF + (rebiased >> 13 & 1)) >> 13;
  } else {  // a multiple of 2^-24: the float addition rounds to it, ties to even
    const float shifted = std::bit_cast<float>(magnitude) + 0.5f;  // 0.5's last bit is 2^-24
    half = std::bit_cast<std::uint32_t>(shifted) - 0x3F000000u;
  }
  return static_cast<std::uint16_t>(sign | half);
}

float float_from(std::uint16_t half) {
  const std::uint32_t sign = static_cast<std::uint32_t>(half & 0x8000) << 16;
  const std::uint32_t exponent = half >> 10 & 31, fraction = half & 0x3FF;
  if (exponent == 31) return std::bit_cast<float>(sign | 0x7F800000 | fraction << 13);
  if (exponent > 0) return std::bit_cast<float>(sign | (exponent + 112) << 23 | fraction << 13);
  const float small = static_cast<float>(fraction) * 0x1p-24f;
  return sign != 0 ? -small : small;
}

}  // namespace gannet::hal
