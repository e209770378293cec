// Silhouette: which pixels of a photo show the target. Start-up only.
#pragma once

#include <cstdint>
#include <vector>

#include "src/vision/yuv_image.hpp"

namespace gannet::vision {

// One byte a pixel, 255 = target, from the difference of a photo and its background. As in P001
// §2.2 what is outside is found by scanning inwards from the image's edge while pixels look like
// the background; like it is judged against the background photo at the same place, which for a
// plain background is the paper's mean hue and for a textured one still works. Only the largest
// piece is kept. Empty when nothing differs.
std::vector<std::uint8_t> find_silhouette(const YuvImage& photo, const YuvImage& background);

}  // namespace gannet::vision
