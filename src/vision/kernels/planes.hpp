// Plane kernels: the passes over whole images that prepare a frame, one table of functions per
// instruction set. All arithmetic is in integers, so every table gives the same bytes. The loops
// are plain (planes_loops.hpp) and left to the compiler; only the instruction set differs. RT safe.
#pragma once

#include <cstdint>

namespace gannet::vision {

// The affine map that spreads a channel's range over 0 … 127, rounded: (254 d + r) / (2 r) with
// d = value − first, 0 … r. In 16 bits: ((d · factor >> 8) + offset) >> shift, exact for each r
// from 16 to 255 (tests try them all).
struct Stretch {
  std::uint8_t first;
  std::uint8_t range;
  std::uint8_t shift;
  std::uint16_t factor;
  std::uint16_t offset;
  // range is at least 16: what varies less is noise.
  static Stretch between(int low, int high);
};

struct PlaneKernels {
  const char* name;

  // (1 4 6 4 1)/16 both ways, σ = 1 pixel; edges repeat. scratch: width + 4 cells. to_stride:
  // bytes from one written row to the next.
  void (*smooth)(const std::uint8_t* from, int width, int height, std::uint16_t* scratch,
                 std::uint8_t* to, int to_stride);
  // Means of 2 × 2 pixels; an odd last row or column is left out.
  void (*halve)(const std::uint8_t* from, int width, int height, std::uint8_t* to);
  // The same for two rows of packed 4:2:2 (luma: the first byte of brightness, 0 or 1), whose
  // chroma counts for both pixels of a pair: half_width pixels of each channel.
  void (*halve_packed)(const std::uint8_t* top, const std::uint8_t* bottom, int half_width,
                       int luma, std::uint8_t* y, std::uint8_t* u, std::uint8_t* v);
  // Least and largest of n >= 1 bytes.
  void (*limits)(const std::uint8_t* from, int n, std::uint8_t* low, std::uint8_t* high);
  // n cells: bytes Y U V, each stretched to 7 bits, and 1. stretch: of Y, U and V.
  void (*pack)(const std::uint8_t* const* yuv, int n, const Stretch* stretch, std::uint32_t* to);
};

extern const PlaneKernels kScalarPlaneKernels;
extern const PlaneKernels kAvx2PlaneKernels;  // x86-64 only

// The best table that this processor has; the same bytes whichever it is.
const PlaneKernels& plane_kernels();

}  // namespace gannet::vision
