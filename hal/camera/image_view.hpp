// ImageView: one image as the driver left it, borrowed for a call, never kept. Says everything that
// a reader needs to know of the bytes: layout, strides, colour matrix and range. RT safe.
#pragma once

#include <array>
#include <cstdint>

namespace gannet::hal {

enum class PixelFormat : std::uint8_t {
  kYuyv,    // packed 4:2:2, Y0 U Y1 V
  kUyvy,    // packed 4:2:2, U Y0 V Y1
  kNv12,    // Y plane, interleaved UV plane at half size both ways
  kYuv422,  // planar, chroma at half width
  kYuv420,  // planar, chroma at half size both ways
  kYuv444,  // planar, chroma at full size
  kRgb24,   // packed R G B (pictures from files, never from a camera)
};

enum class ColourMatrix : std::uint8_t { kBt601, kBt709 };
enum class ColourRange : std::uint8_t { kLimited, kFull };

struct ImageView {
  int width = 0;  // pixels; even for the subsampled formats
  int height = 0;
  PixelFormat format = PixelFormat::kYuyv;
  ColourMatrix matrix = ColourMatrix::kBt601;
  ColourRange range = ColourRange::kLimited;
  std::array<const std::uint8_t*, 3> plane = {};  // unused ones are null
  std::array<int, 3> stride = {};                 // bytes from one row to the next
};

}  // namespace gannet::hal
