// How cameras decode compressed images without knowing a library: they are given a function, such
// as image_file::decode_image. It may take memory and time: normal threads only.
#pragma once

#include <cstdint>
#include <span>

#include "hal/camera/image.hpp"
#include "platform/base/result.hpp"

namespace gannet::hal {

using DecodeImage = Result<Image> (*)(std::span<const std::uint8_t> bytes);

}  // namespace gannet::hal
