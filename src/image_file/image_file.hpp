// Image files by their content, whatever their name says. Normal threads only. Files are written
// beside and renamed, so that nobody sees half of one. Error: path, reason, byte where known.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "hal/camera/image.hpp"
#include "platform/base/result.hpp"
#include "src/image_file/raster.hpp"

namespace gannet::image_file {

inline constexpr std::size_t kMaxFileBytes = std::size_t{1} << 29;

// PNG → RGB24, JPEG → planar YUV (jpeg.hpp). Fits hal::DecodeImage, which cameras are given.
Result<hal::Image> decode_image(std::span<const std::uint8_t> bytes);
Result<hal::Image> read_image(const std::string& path);

Result<Raster8> read_png_rgba(const std::string& path);

// One channel, non-zero = target: the alpha of a PNG that has any transparent pixel, else the
// brightest of R, G, B; a JPEG's Y above 127 (its zeros are not exact).
Result<Raster8> read_mask(const std::string& path);

Result<void> write_png(const std::string& path, const hal::ImageView& view);  // RGB
Result<void> write_png(const std::string& path, const Raster8& raster);
Result<void> write_png(const std::string& path, const Raster16& raster);
Result<void> write_jpeg(const std::string& path, const hal::ImageView& view, int quality = 92);

}  // namespace gannet::image_file
