// JPEG in memory, through libjpeg-turbo (the only file pair that includes turbojpeg.h). Decoded to
// planar YUV as it is stored, never by way of RGB, full-range BT.601 (JFIF). The library prints
// nothing. Normal threads only (it takes memory).
// Error: the library's reason; a truncated or corrupt image is refused, not shown in part.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hal/camera/image.hpp"
#include "platform/base/result.hpp"

namespace gannet::image_file {

bool is_jpeg(std::span<const std::uint8_t> bytes);  // by its start marker

// 4:2:0, 4:2:2 and 4:4:4 in their planar formats; grey, 4:4:0, 4:1:1 and odd sides as kYuv444 with
// chroma repeated; stored RGB as kRgb24. CMYK is refused.
Result<hal::Image> decode_jpeg(std::span<const std::uint8_t> bytes);

// Any view; quality 1 … 100. kYuv420, kYuv422 and kYuv444 of full-range BT.601 keep their planes,
// others are stored as 4:4:4.
Result<std::vector<std::uint8_t>> encode_jpeg(const hal::ImageView& view, int quality);

}  // namespace gannet::image_file
