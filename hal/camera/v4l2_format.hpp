// Agrees with a V4L2 device on pixel format, size and rate, and knows how its images then lie in
// memory. Negotiating is start-up only (and the thread that opens a device anew); view_of is RT
// safe.
#pragma once

#include <string>

#include "hal/camera/camera_config.hpp"
#include "hal/camera/image_view.hpp"
#include "hal/camera/v4l2_system.hpp"
#include "platform/base/result.hpp"

namespace gannet::hal {

struct V4l2Format {
  int width = 0;  // pixels
  int height = 0;
  bool compressed = false;  // mjpeg: to be decoded, the rest says nothing
  PixelFormat format = PixelFormat::kYuyv;
  ColourMatrix matrix = ColourMatrix::kBt601;
  ColourRange range = ColourRange::kLimited;
  int stride = 0;         // bytes from one row to the next, of each plane
  std::size_t bytes = 0;  // the least that a whole image has
  double rate_hz = 0;     // 0: the driver does not tell
  friend bool operator==(const V4l2Format&, const V4l2Format&) = default;
};

// Error: the driver makes something else of it, with the list of what it offers.
Result<V4l2Format> negotiate(V4l2System& system, int fd, const std::string& device,
                             const V4l2StreamConfig& config);

// base has format.bytes of a format that is not compressed.
ImageView view_of(const V4l2Format& format, const std::uint8_t* base);

// Some columns of a view, from `first` on; both even for subsampled formats. RT safe.
ImageView columns_of(const ImageView& view, int first, int width);

}  // namespace gannet::hal
