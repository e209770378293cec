// What a V4L2 device offers: formats, sizes, rates. Read for `gannet cameras`, and for the refusal
// of a config that does not fit. Start-up only, and the thread that opens a device anew.
#pragma once

#include <string>
#include <vector>

#include "hal/camera/v4l2_system.hpp"
#include "platform/base/result.hpp"

namespace gannet::hal {

struct V4l2Range {
  int min = 0, max = 0, step = 1;  // pixels; min == max: just this
};

struct V4l2OfferedSize {
  V4l2Range width, height;
  std::vector<double> rates_hz;  // falling; of the largest size where sizes are a range
  bool any_rate_between = false;
};

struct V4l2OfferedFormat {
  std::uint32_t fourcc = 0;
  std::string name;         // as in the config where we read it, else the four letters
  std::string description;  // the driver's
  bool is_known = false;    // one that camera.*.format can name
  std::vector<V4l2OfferedSize> sizes;
};

struct V4l2Offer {
  std::string driver, card, bus;
  bool captures = false;  // images, one plane of memory each
  bool streams = false;
  std::vector<V4l2OfferedFormat> formats;
};

// The code of "yuyv", "uyvy", "nv12" or "mjpeg"; 0: none of them.
std::uint32_t fourcc_of(const std::string& format);

// Error: it is no V4L2 device.
Result<V4l2Offer> read_offer(V4l2System& system, int fd, const std::string& device);

// One line a size: "yuyv 640 × 480 at 30, 15 Hz". indent begins each line.
std::string text_of(const V4l2Offer& offer, const std::string& indent);

}  // namespace gannet::hal
