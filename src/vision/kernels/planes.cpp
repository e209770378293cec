#include "src/vision/kernels/planes.hpp"

namespace gannet::vision {
namespace {

bool is_exact(const Stretch& s) {
  for (int d = 0; d <= s.range; ++d) {
    if (((d * s.factor >> 8) + s.offset) >> s.shift != (254 * d + s.range) / (2 * s.range)) {
      return false;
    }
  }
  return true;
}

}  // namespace

Stretch Stretch::between(int low, int high) {
  Stretch s = {};
  s.first = static_cast<std::uint8_t>(low);
  const int range = high - low < 16 ? 16 : high - low;
  s.range = static_cast<std::uint8_t>(range);
  // As many fractional bits as leave the factor, and the sum with the offset, in 16 bits.
  while (s.shift < 8 && (127 << (9 + s.shift)) / range < 65535) ++s.shift;
  // Rounding up the factor is exact for all ranges but one, where the next offset is.
  for (int trial = 0; trial < 12; ++trial) {
    s.factor = static_cast<std::uint16_t>((127 << (8 + s.shift)) / range + 1 - trial % 2);
    s.offset = static_cast<std::uint16_t>((1 << s.shift >> 1) + (trial / 2 + 2) % 6 - 2);
    if (is_exact(s)) break;
  }
  return s;
}

const PlaneKernels& plane_kernels() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2")) return kAvx2PlaneKernels;
#endif
  return kScalarPlaneKernels;
}

}  // namespace gannet::vision
