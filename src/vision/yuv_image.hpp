// YuvImage: interleaved full-range BT.601 Y U V bytes of a whole image, for building models.
// Start-up only.
#pragma once

#include <cstdint>
#include <vector>

#include "hal/camera/image_view.hpp"
#include "src/core/stereo_rig.hpp"
#include "src/vision/patch_model.hpp"

namespace gannet::vision {

struct YuvImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> yuv;  // width · height · 3

  const std::uint8_t* at(int x, int y) const {
    return yuv.data() + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                             static_cast<std::size_t>(x));
  }
  std::uint8_t* at(int x, int y) {
    return yuv.data() + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                             static_cast<std::size_t>(x));
  }
};

YuvImage to_yuv(const hal::ImageView& view);

// The image that a pinhole camera with the same cx, cy and the camera's magnification as focal
// lengths would have taken of things at this depth (bilinear; black where the camera saw nothing).
// The same image where neither lens nor port bends light; the depth matters to a port alone.
YuvImage undistorted(YuvImage image, const Intrinsics& camera, double depth_m);

// Means over (2·radius + 1)² pixels, edges repeated.
YuvImage box_blurred(const YuvImage& image, int radius);

}  // namespace gannet::vision
