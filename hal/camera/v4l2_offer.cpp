#include "hal/camera/v4l2_offer.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace gannet::hal {
namespace {

// A driver that enumerates without end is cut off here.
constexpr std::uint32_t kMostFormats = 64, kMostSizes = 256, kMostRates = 64;

struct KnownFormat {
  std::uint32_t fourcc;
  const char* name;
};
constexpr KnownFormat kKnown[] = {{V4L2_PIX_FMT_YUYV, "yuyv"},
                                  {V4L2_PIX_FMT_UYVY, "uyvy"},
                                  {V4L2_PIX_FMT_NV12, "nv12"},
                                  {V4L2_PIX_FMT_MJPEG, "mjpeg"}};

template <std::size_t N>
std::string words_of(const __u8 (&text)[N]) {
  const auto* letters = reinterpret_cast<const char*>(text);
  return {letters, strnlen(letters, N)};
}

std::string letters_of(std::uint32_t fourcc) {
  std::string text;
  for (int shift = 0; shift < 32; shift += 8) {
    const char c = static_cast<char>(fourcc >> shift & 0x7f);
    text += c < ' ' ? '?' : c;
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

double rate_of(const v4l2_fract& interval) {
  return interval.numerator == 0 ? 0 : double{1} * interval.denominator / interval.numerator;
}

V4l2Range range_of(std::uint32_t min, std::uint32_t max, std::uint32_t step) {
  return {static_cast<int>(min), static_cast<int>(max), std::max(1, static_cast<int>(step))};
}

void read_rates(V4l2System& system, int fd, std::uint32_t fourcc, V4l2OfferedSize& size) {
  for (std::uint32_t i = 0; i < kMostRates; ++i) {
    v4l2_frmivalenum query = {};
    query.index = i;
    query.pixel_format = fourcc;
    query.width = static_cast<std::uint32_t>(size.width.max);
    query.height = static_cast<std::uint32_t>(size.height.max);
    if (system.ioctl(fd, VIDIOC_ENUM_FRAMEINTERVALS, &query) != 0) break;
    if (query.type == V4L2_FRMIVAL_TYPE_DISCRETE) {
      size.rates_hz.push_back(rate_of(query.discrete));
      continue;
    }
    size.any_rate_between = true;
    size.rates_hz = {rate_of(query.stepwise.min), rate_of(query.stepwise.max)};
    break;
  }
  std::sort(size.rates_hz.rbegin(), size.rates_hz.rend());
}

void read_sizes(V4l2System& system, int fd, V4l2OfferedFormat& format) {
  for (std::uint32_t i = 0; i < kMostSizes; ++i) {
    v4l2_frmsizeenum query = {};
    query.index = i;
    query.pixel_format = format.fourcc;
    if (system.ioctl(fd, VIDIOC_ENUM_FRAMESIZES, &query) != 0) break;
    V4l2OfferedSize size;
    const bool discrete = query.type == V4L2_FRMSIZE_TYPE_DISCRETE;
    if (discrete) {
      size.width = range_of(query.discrete.width, query.discrete.width, 1);
      size.height = range_of(query.discrete.height, query.discrete.height, 1);
    } else {
      const auto& s = query.stepwise;
      size.width = range_of(s.min_width, s.max_width, s.step_width);
      size.height = range_of(s.min_height, s.max_height, s.step_height);
    }
    read_rates(system, fd, format.fourcc, size);
    format.sizes.push_back(std::move(size));
    if (!discrete) break;  // a range is the whole answer
  }
}

std::string text_of(const V4l2Range& range) {
  std::string text = std::to_string(range.min);
  if (range.max == range.min) return text;
  text += " … " + std::to_string(range.max);
  return range.step > 1 ? text + " by " + std::to_string(range.step) : text;
}

std::string number_text(double number) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", number);
  return buffer;
}

std::string text_of(const V4l2OfferedSize& size) {
  std::string text = text_of(size.width) + " × " + text_of(size.height);
  for (std::size_t i = 0; i < size.rates_hz.size(); ++i)
    text += (i == 0                  ? " at "
             : size.any_rate_between ? " … "
                                     : ", ") +
            number_text(size.rates_hz[i]);
  return size.rates_hz.empty() ? text : text + " Hz";
}

}  // namespace

std::uint32_t fourcc_of(const std::string& format) {
  for (const KnownFormat& known : kKnown)
    if (format == known.name) return known.fourcc;
  return 0;
}

Result<V4l2Offer> read_offer(V4l2System& system, int fd, const std::string& device) {
  v4l2_capability capability = {};
  if (const int error = system.ioctl(fd, VIDIOC_QUERYCAP, &capability); error != 0)
    return Error{device + ": is no V4L2 device: " + std::strerror(-error)};
  // The node's own abilities where the driver tells them apart from its other nodes'.
  const std::uint32_t abilities = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0
                                      ? capability.device_caps
                                      : capability.capabilities;
  V4l2Offer offer = {.driver = words_of(capability.driver),
                     .card = words_of(capability.card),
                     .bus = words_of(capability.bus_info),
                     .captures = (abilities & V4L2_CAP_VIDEO_CAPTURE) != 0,
                     .streams = (abilities & V4L2_CAP_STREAMING) != 0,
                     .formats = {}};
  for (std::uint32_t i = 0; offer.captures && i < kMostFormats; ++i) {
    v4l2_fmtdesc query = {};
    query.index = i;
    query.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (system.ioctl(fd, VIDIOC_ENUM_FMT, &query) != 0) break;
    V4l2OfferedFormat format = {.fourcc = query.pixelformat,
                                .name = letters_of(query.pixelformat),
                                .description = words_of(query.description),
                                .is_known = false,
                                .sizes = {}};
    for (const KnownFormat& known : kKnown) {
      if (known.fourcc != query.pixelformat) continue;
      format.name = known.name;
      format.is_known = true;
    }
    read_sizes(system, fd, format);
    offer.formats.push_back(std::move(format));
  }
  return offer;
}

std::string text_of(const V4l2Offer& offer, const std::string& indent) {
  std::string text;
  for (const V4l2OfferedFormat& format : offer.formats) {
    const std::string name = indent + format.name + (format.is_known ? " " : " (not usable) ");
    for (const V4l2OfferedSize& size : format.sizes) text += name + text_of(size) + "\n";
    if (format.sizes.empty()) text += name + "of sizes that the driver does not tell\n";
  }
  if (!text.empty()) text.pop_back();
  return text;
}

}  // namespace gannet::hal
