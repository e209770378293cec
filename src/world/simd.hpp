// Float4: four floats that go through arithmetic together: R, G, B and alpha of one pixel. The
// compilers' own vectors, so that x86 and ARM run the same operations in the same order.
// Any thread.
#pragma once

namespace gannet::world {

using Float4 [[gnu::vector_size(16)]] = float;
using Int4 [[gnu::vector_size(16)]] = int;

inline Float4 splat(float x) { return Float4{x, x, x, x}; }
inline Float4 min4(Float4 a, Float4 b) { return a < b ? a : b; }
inline Float4 max4(Float4 a, Float4 b) { return a > b ? a : b; }

// Truncation toward minus infinity without libm; |x| < 2³⁰.
inline int floor_int(float x) {
  const int i = static_cast<int>(x);
  return i - (static_cast<float>(i) > x ? 1 : 0);
}

}  // namespace gannet::world
