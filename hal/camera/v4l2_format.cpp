#include "hal/camera/v4l2_format.hpp"

#include <cmath>
#include <cstdio>
#include <cstring>

#include "hal/camera/image.hpp"
#include "hal/camera/v4l2_offer.hpp"

namespace gannet::hal {
namespace {

std::string number_text(double number) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", number);
  return buffer;
}

std::string wish_text(const V4l2StreamConfig& config) {
  return config.format + " " + std::to_string(config.width) + " × " +
         std::to_string(config.height) +
         (config.rate_hz > 0 ? " at " + number_text(config.rate_hz) + " Hz" : "");
}

Error does_not_fit(V4l2System& system, int fd, const std::string& device,
                   const V4l2StreamConfig& config, const std::string& instead) {
  std::string text = device + ": does not give " + wish_text(config) + " (" + instead + ")";
  const auto offer = read_offer(system, fd, device);
  const std::string list = offer ? text_of(*offer, "  ") : "";
  return Error{list.empty() ? text : text + "; it offers\n" + list};
}

PixelFormat pixel_format_of(std::uint32_t fourcc) {
  return fourcc == V4L2_PIX_FMT_UYVY   ? PixelFormat::kUyvy
         : fourcc == V4L2_PIX_FMT_NV12 ? PixelFormat::kNv12
                                       : PixelFormat::kYuyv;
}

// What a default stands for depends on the colour space: the kernel's header says how.
void set_colours(const v4l2_pix_format& pix, V4l2Format& format) {
  std::uint32_t matrix = pix.ycbcr_enc, range = pix.quantization;
  if (matrix == V4L2_YCBCR_ENC_DEFAULT) matrix = V4L2_MAP_YCBCR_ENC_DEFAULT(pix.colorspace);
  if (range == V4L2_QUANTIZATION_DEFAULT)
    range = V4L2_MAP_QUANTIZATION_DEFAULT(false, pix.colorspace, matrix);
  format.matrix = matrix == V4L2_YCBCR_ENC_709 || matrix == V4L2_YCBCR_ENC_XV709
                      ? ColourMatrix::kBt709
                      : ColourMatrix::kBt601;
  format.range = range == V4L2_QUANTIZATION_FULL_RANGE ? ColourRange::kFull : ColourRange::kLimited;
}

void set_layout(const v4l2_pix_format& pix, V4l2Format& format) {
  const ImageLayout tight = layout_of(format.format, format.width, format.height);
  const auto told = static_cast<int>(pix.bytesperline);
  format.stride = told > tight.stride[0] && told < 16 * kMaxImageSide ? told : tight.stride[0];
  int rows = 0;
  for (const int plane_rows : tight.rows) rows += plane_rows;
  // The padding behind the last row may be missing.
  format.bytes = std::size_t{1} * static_cast<std::size_t>(rows - 1) *
                     static_cast<std::size_t>(format.stride) +
                 static_cast<std::size_t>(tight.stride[0]);
}

Result<V4l2Format> set_format(V4l2System& system, int fd, const std::string& device,
                              const V4l2StreamConfig& config) {
  v4l2_format asked = {};
  asked.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  v4l2_pix_format& pix = asked.fmt.pix;
  pix.width = static_cast<std::uint32_t>(config.width);
  pix.height = static_cast<std::uint32_t>(config.height);
  pix.pixelformat = fourcc_of(config.format);
  pix.field = V4L2_FIELD_NONE;  // progressive
  if (const int error = system.ioctl(fd, VIDIOC_S_FMT, &asked); error != 0)
    return does_not_fit(system, fd, device, config, std::strerror(-error));
  if (pix.pixelformat != fourcc_of(config.format))
    return does_not_fit(system, fd, device, config, "it takes another format");
  if (static_cast<int>(pix.width) != config.width || static_cast<int>(pix.height) != config.height)
    return does_not_fit(
        system, fd, device, config,
        "it makes " + std::to_string(pix.width) + " × " + std::to_string(pix.height) + " of it");
  V4l2Format format = {.width = config.width,
                       .height = config.height,
                       .compressed = pix.pixelformat == V4L2_PIX_FMT_MJPEG,
                       .format = pixel_format_of(pix.pixelformat)};
  if (format.compressed) return format;
  if (layout_of(format.format, format.width, format.height).bytes == 0)
    return Error{device + ": " + wish_text(config) + ": sides must be even"};
  set_colours(pix, format);
  set_layout(pix, format);
  return format;
}

// The rate that the driver says it keeps; 0: it does not tell.
Result<double> set_rate(V4l2System& system, int fd, const std::string& device,
                        const V4l2StreamConfig& config) {
  v4l2_streamparm parameters = {};
  parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  v4l2_captureparm& capture = parameters.parm.capture;
  const bool settable = system.ioctl(fd, VIDIOC_G_PARM, &parameters) == 0 &&
                        (capture.capability & V4L2_CAP_TIMEPERFRAME) != 0;
  if (config.rate_hz > 0) {
    v4l2_streamparm asked = parameters;
    // In millihertz, so that 29.97 is not rounded.
    asked.parm.capture.timeperframe = {
        1000, static_cast<std::uint32_t>(std::lround(config.rate_hz * 1000))};
    const int error = system.ioctl(fd, VIDIOC_S_PARM, &asked);
    if (error != 0 && settable)
      return does_not_fit(system, fd, device, config, std::strerror(-error));
    // Asked of all: v4l2loopback takes a rate although it does not say that it can.
    if (error == 0) parameters = asked;
  }
  const v4l2_fract& interval = capture.timeperframe;
  const double rate_hz =
      interval.numerator == 0 ? 0 : double{1} * interval.denominator / interval.numerator;
  if (config.rate_hz > 0 && rate_hz > 0 &&
      std::abs(rate_hz - config.rate_hz) > 0.01 * config.rate_hz)
    return does_not_fit(system, fd, device, config, "it keeps " + number_text(rate_hz) + " Hz");
  return rate_hz;
}

}  // namespace

Result<V4l2Format> negotiate(V4l2System& system, int fd, const std::string& device,
                             const V4l2StreamConfig& config) {
  auto format = set_format(system, fd, device, config);
  if (!format) return format;
  const auto rate_hz = set_rate(system, fd, device, config);
  if (!rate_hz) return rate_hz.error();
  format->rate_hz = *rate_hz;
  return format;
}

ImageView view_of(const V4l2Format& format, const std::uint8_t* base) {
  ImageView view{format.width, format.height, format.format, format.matrix, format.range, {}, {}};
  view.plane[0] = base;
  view.stride[0] = format.stride;
  if (format.format == PixelFormat::kNv12) {
    view.plane[1] = base + std::ptrdiff_t{format.stride} * format.height;
    view.stride[1] = format.stride;
  }
  return view;
}

ImageView columns_of(const ImageView& view, int first, int width) {
  ImageView part = view;
  part.width = width;
  const auto skip = [&](std::size_t plane, int bytes) { part.plane[plane] += bytes; };
  switch (view.format) {
    case PixelFormat::kYuyv:
    case PixelFormat::kUyvy:
      skip(0, 2 * first);
      break;
    case PixelFormat::kNv12:
      skip(0, first), skip(1, first);
      break;
    case PixelFormat::kYuv422:
    case PixelFormat::kYuv420:
      skip(0, first), skip(1, first / 2), skip(2, first / 2);
      break;
    case PixelFormat::kYuv444:
      skip(0, first), skip(1, first), skip(2, first);
      break;
    case PixelFormat::kRgb24:
      skip(0, 3 * first);
      break;
  }
  return part;
}

}  // namespace gannet::hal
