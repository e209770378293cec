// The loops of planes.hpp, included by each planes_*.cpp and compiled there for its instruction
// set; everything has internal linkage. 16-bit arithmetic, for twice the lanes. RT safe.
#pragma once

#include <cstring>

#include "src/vision/kernels/planes.hpp"

namespace gannet::vision {
namespace {

using Byte = std::uint8_t;
using Word = std::uint16_t;

inline int clamped(int row, int height) { return row < 0 ? 0 : row < height ? row : height - 1; }

// The vertical sums of a row (at most 16 · 255) are kept in scratch, two pads on each side; both
// passes stay within 16 bits: 16 · 4080 + 128 < 65536.
void smooth(const Byte* from, int width, int height, Word* scratch, Byte* to, int to_stride) {
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
    Byte* const out = to + row * to_stride;
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

// Four bytes at a time hold two pixels: sums of 16 bits side by side.
void halve_packed(const Byte* top, const Byte* bottom, int half_width, int luma, Byte* y, Byte* u,
                  Byte* v) {
  constexpr std::uint32_t kEven = 0x00FF00FF;
  const int bright = 8 * luma, chroma = 8 - bright;
  for (int i = 0; i < half_width; ++i) {
    std::uint32_t a, b;
    std::memcpy(&a, top + 4 * i, 4);
    std::memcpy(&b, bottom + 4 * i, 4);
    const std::uint32_t light = (a >> bright & kEven) + (b >> bright & kEven);
    const std::uint32_t colour = (a >> chroma & kEven) + (b >> chroma & kEven) + 0x00010001;
    y[i] = static_cast<Byte>(((light & 0xFFFF) + (light >> 16) + 2) >> 2);
    u[i] = static_cast<Byte>(colour >> 1);
    v[i] = static_cast<Byte>(colour >> 17);
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

inline Word stretched(Byte from, Byte first, Byte range, Word factor, Word offset, Byte shift) {
  const Byte above = from > first ? static_cast<Byte>(from - first) : Byte{0};
  const Word d = static_cast<Word>((above < range ? above : range) << 8);
  const Word high = static_cast<Word>(std::uint32_t{d} * factor >> 16);
  return static_cast<Word>(static_cast<Word>(high + offset) >> shift);
}

// A part of a channel, shifted left, into a buffer that stays in the nearest cache.
template <int kLeft>
inline void stretch_part(const Byte* from, int n, const Stretch& s, Word* to) {
  const Byte first = s.first, range = s.range, shift = s.shift;
  const Word factor = s.factor, offset = s.offset;
  for (int i = 0; i < n; ++i) {
    to[i] = static_cast<Word>(stretched(from[i], first, range, factor, offset, shift) << kLeft);
  }
}

void pack(const Byte* const* yuv, int n, const Stretch* stretch, std::uint32_t* to) {
  constexpr int kPart = 512;
  alignas(64) Word part[3][kPart];
  for (int at = 0; at < n; at += kPart) {
    const int size = n - at < kPart ? n - at : kPart;
    stretch_part<0>(yuv[0] + at, size, stretch[0], part[0]);
    stretch_part<8>(yuv[1] + at, size, stretch[1], part[1]);
    stretch_part<0>(yuv[2] + at, size, stretch[2], part[2]);
    for (int i = 0; i < size; ++i) {
      const Word low = static_cast<Word>(part[0][i] | part[1][i]);
      const Word high = static_cast<Word>(part[2][i] | 1 << 8);
      to[at + i] = std::uint32_t{low} | std::uint32_t{high} << 16;
    }
  }
}

}  // namespace
}  // namespace gannet::vision
