// The loops of planes.hpp, included by each planes_*.cpp and compiled there for its instruction
// set; everything has internal linkage. 16-bit arithmetic, for twice the lanes. RT safe.
#pragma once

#include "src/vision/kernels/planes.hpp"

namespace gannet::vision {
namespace {

using Byte = std::uint8_t;
using Word = std::uint16_t;

inline int clamped(int row, int height) { return row < 0 ? 0 : row < height ? row : height - 1; }

// The vertical sums of a row (at most 16 · 255) are kept in scratch, two pads on each side; both
// passes stay within 16 bits: 16 · 4080 + 128 < 65536.
void smooth(const Byte* from, int width, int height, Word* scratch, Byte* to) {
  Word* const sums = scratch + 2;
  for (int row = 0; row < height; ++row) {
    const Byte* const a = from + clamped(row - 2, height) * width;
    const Byte* const b = from + clamped(row - 1, height) * width;
    const Byte* const c = from + row * width;
    const Byte* const d = from + clamped(row + 1, height) * width;
    const Byte* const e = from + clamped(row + 2, height) * width;
    for (int i = 0; i < width; ++i) {
      sums[i] = static_cast<Word>(a[i] + e[i] + 4 * (b[i] + d[i]) + 6 * c[i]);
    }
    sums[-2] = sums[-1] = sums[0];
    sums[width] = sums[width + 1] = sums[width - 1];
    Byte* const out = to + row * width;
    for (int i = 0; i < width; ++i) {
      const Word sum = static_cast<Word>(sums[i - 2] + sums[i + 2] +
                                         4 * (sums[i - 1] + sums[i + 1]) + 6 * sums[i] + 128);
      out[i] = static_cast<Byte>(sum >> 8);
    }
  }
}

void halve(const Byte* from, int width, int height, Byte* to) {
  const int half_width = width / 2;
  for (int row = 0; row < height / 2; ++row) {
    const Byte* const top = from + 2 * row * width;
    const Byte* const bottom = top + width;
    Byte* const out = to + row * half_width;
    for (int i = 0; i < half_width; ++i) {
      const Word sum =
          static_cast<Word>(top[2 * i] + top[2 * i + 1] + bottom[2 * i] + bottom[2 * i + 1] + 2);
      out[i] = static_cast<Byte>(sum >> 2);
    }
  }
}

void limits(const Byte* from, int n, Byte* low, Byte* high) {
  Byte least = 255, most = 0;
  for (int i = 0; i < n; ++i) {
    least = from[i] < least ? from[i] : least;
    most = from[i] > most ? from[i] : most;
  }
  *low = least;
  *high = most;
}

// A part of a channel, into a buffer that stays in the nearest cache.
inline void stretch_part(const Byte* from, int n, const Stretch& s, Byte* to) {
  const Byte first = s.first, range = s.range, shift = s.shift;
  const Word factor = s.factor, offset = s.offset;
  for (int i = 0; i < n; ++i) {
    const Byte above = from[i] > first ? static_cast<Byte>(from[i] - first) : Byte{0};
    const Word d = static_cast<Word>((above < range ? above : range) << 8);
    const Word high = static_cast<Word>(std::uint32_t{d} * factor >> 16);
    to[i] = static_cast<Byte>(static_cast<Word>(high + offset) >> shift);
  }
}

void pack(const Byte* const* yuv, int n, const Stretch* stretch, std::uint32_t* to) {
  constexpr int kPart = 512;
  alignas(64) Byte part[3][kPart];
  for (int at = 0; at < n; at += kPart) {
    const int size = n - at < kPart ? n - at : kPart;
    for (int c = 0; c < 3; ++c) stretch_part(yuv[c] + at, size, stretch[c], part[c]);
    for (int i = 0; i < size; ++i) {
      to[at + i] = std::uint32_t{part[0][i]} | std::uint32_t{part[1][i]} << 8 |
                   std::uint32_t{part[2][i]} << 16 | 1u << 24;
    }
  }
}

}  // namespace
}  // namespace gannet::vision
