// One row of any image format as full-range BT.601 Y, U, V at full width. RT safe.
#pragma once

#include <cstdint>

#include "hal/camera/image_view.hpp"

namespace gannet::vision {

// y, u, v hold at least image.width + 1 bytes. row in [0, height).
void unpack_row(const hal::ImageView& image, int row, std::uint8_t* y, std::uint8_t* u,
                std::uint8_t* v);

// The two halves of it: the bytes as they are, and any number of such pixels to full-range BT.601.
void unpack_raw_row(const hal::ImageView& image, int row, std::uint8_t* y, std::uint8_t* u,
                    std::uint8_t* v);
void to_full_bt601(const hal::ImageView& image, int count, std::uint8_t* y, std::uint8_t* u,
                   std::uint8_t* v);

// The columns [first, first + width) of an image; first is even.
hal::ImageView columns_of(const hal::ImageView& image, int first, int width);

}  // namespace gannet::vision
