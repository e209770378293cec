// PNG in memory, through libpng (the only file pair that includes png.h). Sample values are taken
// as they stand: no gamma, no colour profile. The library prints nothing. Normal threads only.
// Error: the reason and the byte where reading stopped; sides above hal::kMaxImageSide, or more
// than kMaxPixels, are refused before memory is taken.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hal/camera/image.hpp"
#include "platform/base/result.hpp"
#include "src/image_file/raster.hpp"

namespace gannet::image_file {

inline constexpr std::int64_t kMaxPixels = std::int64_t{1} << 26;  // 8192 × 8192

bool is_png(std::span<const std::uint8_t> bytes);  // by its signature

// RGB24 of any PNG: palettes and greys are expanded, 16 bits lose the lower 8, alpha is dropped.
Result<hal::Image> decode_png(std::span<const std::uint8_t> bytes);

// channels 1, 3 or 4, 8 bits each. A PNG without alpha is opaque; grey of colours is BT.601 luma.
Result<Raster8> decode_png8(std::span<const std::uint8_t> bytes, int channels);

// The same with all its 16 bits; 8 bits are widened (0xAB → 0xABAB).
Result<Raster16> decode_png16(std::span<const std::uint8_t> bytes, int channels = 1);

// Error: sizes that do not fit together.
Result<std::vector<std::uint8_t>> encode_png(const Raster8& raster);
Result<std::vector<std::uint8_t>> encode_png(const Raster16& raster);
Result<std::vector<std::uint8_t>> encode_png(const hal::ImageView& view);  // as RGB

}  // namespace gannet::image_file
