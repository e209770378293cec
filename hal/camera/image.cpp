#include "hal/camera/image.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "hal/camera/pixel_access.hpp"

namespace gannet::hal {
namespace {

struct Shape {
  int bytes_per_row;
  int rows;
};

// The planes of a format; bytes_per_row 0 ends the list.
std::array<Shape, 3> shapes(PixelFormat format, int w, int h) {
  switch (format) {
    case PixelFormat::kYuyv:
    case PixelFormat::kUyvy:
      return {{{2 * w, h}, {}, {}}};
    case PixelFormat::kNv12:
      return {{{w, h}, {w, h / 2}, {}}};
    case PixelFormat::kYuv422:
      return {{{w, h}, {w / 2, h}, {w / 2, h}}};
    case PixelFormat::kYuv420:
      return {{{w, h}, {w / 2, h / 2}, {w / 2, h / 2}}};
    case PixelFormat::kYuv444:
      return {{{w, h}, {w, h}, {w, h}}};
    case PixelFormat::kRgb24:
      return {{{3 * w, h}, {}, {}}};
  }
  return {};
}

bool size_suits(PixelFormat format, int w, int h) {
  if (w < 1 || h < 1 || w > kMaxImageSide || h > kMaxImageSide) return false;
  switch (format) {
    case PixelFormat::kYuyv:
    case PixelFormat::kUyvy:
    case PixelFormat::kYuv422:
      return w % 2 == 0;
    case PixelFormat::kNv12:
    case PixelFormat::kYuv420:
      return w % 2 == 0 && h % 2 == 0;
    case PixelFormat::kYuv444:
    case PixelFormat::kRgb24:
      return true;
  }
  return false;
}

// Calls put(x, y, a, b, c) for the stored codes of each pixel.
template <class Put>
void for_each_pixel(const ImageView& view, Put put) {
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      const auto [a, b, c] = stored_at(view, x, y);
      put(x, y, a, b, c);
    }
}

}  // namespace

ImageLayout layout_of(PixelFormat format, int width, int height) {
  ImageLayout layout;
  if (!size_suits(format, width, height)) return layout;
  const auto planes = shapes(format, width, height);
  for (std::size_t i = 0; i < 3 && planes[i].bytes_per_row > 0; ++i) {
    layout.planes = static_cast<int>(i) + 1;
    layout.offset[i] = layout.bytes;
    layout.stride[i] = planes[i].bytes_per_row;
    layout.rows[i] = planes[i].rows;
    const std::size_t bytes = static_cast<std::size_t>(planes[i].bytes_per_row) *
                              static_cast<std::size_t>(planes[i].rows);
    layout.bytes += (bytes + 63) / 64 * 64;
  }
  return layout;
}

ImageView view_of(const ImageLayout& layout, const std::uint8_t* base, PixelFormat format,
                  int width, int height, ColourMatrix matrix, ColourRange range) {
  ImageView view{width, height, format, matrix, range, {}, {}};
  for (std::size_t i = 0; i < static_cast<std::size_t>(layout.planes); ++i) {
    view.plane[i] = base + layout.offset[i];
    view.stride[i] = layout.stride[i];
  }
  return view;
}

const char* to_string(PixelFormat format) {
  switch (format) {
    case PixelFormat::kYuyv:
      return "yuyv";
    case PixelFormat::kUyvy:
      return "uyvy";
    case PixelFormat::kNv12:
      return "nv12";
    case PixelFormat::kYuv422:
      return "yuv422";
    case PixelFormat::kYuv420:
      return "yuv420";
    case PixelFormat::kYuv444:
      return "yuv444";
    case PixelFormat::kRgb24:
      return "rgb24";
  }
  return "unknown";
}

Image::Image(int width, int height, PixelFormat format, ColourMatrix matrix, ColourRange range)
    : width_(width),
      height_(height),
      format_(format),
      matrix_(matrix),
      range_(range),
      layout_(layout_of(format, width, height)),
      bytes_(layout_.bytes) {
  assert(!bytes_.empty());
}

ImageView Image::view() const {
  return view_of(layout_, bytes_.data(), format_, width_, height_, matrix_, range_);
}

bool is_complete(const ImageView& view) {
  const ImageLayout layout = layout_of(view.format, view.width, view.height);
  if (layout.bytes == 0) return false;
  for (std::size_t i = 0; i < static_cast<std::size_t>(layout.planes); ++i)
    if (view.plane[i] == nullptr || view.stride[i] < layout.stride[i]) return false;
  return true;
}

Image copy_of(const ImageView& view) {
  Image image(view.width, view.height, view.format, view.matrix, view.range);
  const ImageLayout& layout = image.layout();
  for (int i = 0; i < layout.planes; ++i) {
    const auto at = static_cast<std::size_t>(i);
    for (int y = 0; y < layout.rows[at]; ++y)
      std::memcpy(image.row(i, y), view.plane[at] + std::ptrdiff_t{y} * view.stride[at],
                  static_cast<std::size_t>(layout.stride[at]));
  }
  return image;
}

Image to_yuv444(const ImageView& view) {
  Image image(view.width, view.height, PixelFormat::kYuv444);
  const ColourMap map = full_bt601_from(view.format, view.matrix, view.range);
  for_each_pixel(view, [&](int x, int y, double a, double b, double c) {
    const YuvPixel pixel = to_yuv(map, a, b, c);
    image.row(0, y)[x] = pixel.y;
    image.row(1, y)[x] = pixel.u;
    image.row(2, y)[x] = pixel.v;
  });
  return image;
}

Image to_rgb24(const ImageView& view) {
  if (view.format == PixelFormat::kRgb24) return copy_of(view);
  Image image(view.width, view.height, PixelFormat::kRgb24);
  const ColourMap map = rgb_from_yuv(view.matrix, view.range);
  for_each_pixel(view, [&](int x, int y, double a, double b, double c) {
    const RgbPixel pixel = to_rgb(map, a, b, c);
    std::uint8_t* out = image.row(0, y) + 3 * x;
    out[0] = pixel.r, out[1] = pixel.g, out[2] = pixel.b;
  });
  return image;
}

}  // namespace gannet::hal
