// Where a rendered picture goes: the caller's memory, laid out as an ImageView says. Developed rows
// of R, G, B codes become YUV (any matrix and range of hal) with chroma averaged over the cell that
// shares it. Any thread, each its own rows.
#pragma once

#include <array>
#include <cstdint>

#include "hal/camera/image.hpp"
#include "hal/camera/image_view.hpp"
#include "src/world/simd.hpp"

namespace gannet::world {

// An ImageView that may be written to. Sides even.
struct ImageTarget {
  int width = 0;
  int height = 0;
  hal::PixelFormat format = hal::PixelFormat::kYuyv;
  hal::ColourMatrix matrix = hal::ColourMatrix::kBt601;
  hal::ColourRange range = hal::ColourRange::kLimited;
  std::array<std::uint8_t*, 3> plane = {};
  std::array<int, 3> stride = {};
};
ImageTarget target_of(hal::Image& image);

// The same layout in a block of shared memory: hal::layout_of and hal::view_of for writing.
ImageTarget target_of(const hal::ImageLayout& layout, std::uint8_t* base, hal::PixelFormat format,
                      int width, int height, hal::ColourMatrix matrix, hal::ColourRange range);

// Writes rows y and y + 1 (y even). upper, lower: R, G, B codes 0 … 255, used up by the call.
void write_rows(const ImageTarget& target, int y, Float4* upper, Float4* lower);

}  // namespace gannet::world
