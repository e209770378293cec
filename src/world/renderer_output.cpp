#include "src/world/renderer_output.hpp"

#include "hal/camera/pixel_access.hpp"

namespace gannet::world {
namespace {

using hal::PixelFormat;

struct Codes {
  std::uint8_t a, b, c;
};

Codes rounded(Float4 x) {
  const Float4 half = splat(0.5f);
  const Int4 i = __builtin_convertvector(min4(max4(x + half, splat(0)), splat(255)), Int4);
  return {static_cast<std::uint8_t>(i[0]), static_cast<std::uint8_t>(i[1]),
          static_cast<std::uint8_t>(i[2])};
}

void to_yuv(const ImageTarget& target, Float4* row) {
  const hal::ColourMap map = hal::yuv_from_rgb(target.matrix, target.range);
  const auto column = [&](std::size_t i) {
    return Float4{static_cast<float>(map.m[i]), static_cast<float>(map.m[3 + i]),
                  static_cast<float>(map.m[6 + i]), 0};
  };
  const Float4 red = column(0), green = column(1), blue = column(2);
  const Float4 offset = {static_cast<float>(map.out_offset[0]),
                         static_cast<float>(map.out_offset[1]),
                         static_cast<float>(map.out_offset[2]), 0};
  for (int x = 0; x < target.width; ++x) {
    const Float4 c = row[x];
    row[x] = ((red * splat(c[0]) + green * splat(c[1])) + blue * splat(c[2])) + offset;
  }
}

std::uint8_t* line(const ImageTarget& target, std::size_t plane, int y) {
  return target.plane[plane] + std::ptrdiff_t{y} * target.stride[plane];
}

// One row of a format whose chroma belongs to single rows.
void write_row(const ImageTarget& target, int y, const Float4* row) {
  std::uint8_t* out = line(target, 0, y);
  for (int x = 0; x < target.width; x += 2) {
    const Codes left = rounded(row[x]), right = rounded(row[x + 1]);
    const Codes cell = rounded((row[x] + row[x + 1]) * 0.5f);
    switch (target.format) {
      case PixelFormat::kYuyv:
        out[2 * x] = left.a, out[2 * x + 1] = cell.b;
        out[2 * x + 2] = right.a, out[2 * x + 3] = cell.c;
        break;
      case PixelFormat::kUyvy:
        out[2 * x] = cell.b, out[2 * x + 1] = left.a;
        out[2 * x + 2] = cell.c, out[2 * x + 3] = right.a;
        break;
      case PixelFormat::kYuv422:
        out[x] = left.a, out[x + 1] = right.a;
        line(target, 1, y)[x / 2] = cell.b, line(target, 2, y)[x / 2] = cell.c;
        break;
      case PixelFormat::kYuv444:
        out[x] = left.a, out[x + 1] = right.a;
        line(target, 1, y)[x] = left.b, line(target, 1, y)[x + 1] = right.b;
        line(target, 2, y)[x] = left.c, line(target, 2, y)[x + 1] = right.c;
        break;
      case PixelFormat::kRgb24:
        out[3 * x] = left.a, out[3 * x + 1] = left.b, out[3 * x + 2] = left.c;
        out[3 * x + 3] = right.a, out[3 * x + 4] = right.b, out[3 * x + 5] = right.c;
        break;
      default:  // NV12 and 4:2:0 share chroma between rows
        out[x] = left.a, out[x + 1] = right.a;
        break;
    }
  }
}

void write_shared_chroma(const ImageTarget& target, int y, const Float4* upper,
                         const Float4* lower) {
  for (int x = 0; x < target.width; x += 2) {
    const Codes cell = rounded(((upper[x] + upper[x + 1]) + (lower[x] + lower[x + 1])) * 0.25f);
    if (target.format == PixelFormat::kNv12) {
      line(target, 1, y / 2)[x] = cell.b, line(target, 1, y / 2)[x + 1] = cell.c;
    } else {
      line(target, 1, y / 2)[x / 2] = cell.b, line(target, 2, y / 2)[x / 2] = cell.c;
    }
  }
}

}  // namespace

ImageTarget target_of(const hal::ImageLayout& layout, std::uint8_t* base, PixelFormat format,
                      int width, int height, hal::ColourMatrix matrix, hal::ColourRange range) {
  ImageTarget target{width, height, format, matrix, range, {}, layout.stride};
  for (std::size_t i = 0; i < static_cast<std::size_t>(layout.planes); ++i)
    target.plane[i] = base + layout.offset[i];
  return target;
}

ImageTarget target_of(hal::Image& image) {
  const hal::ImageView view = image.view();
  return target_of(image.layout(), image.bytes().data(), view.format, view.width, view.height,
                   view.matrix, view.range);
}

void write_rows(const ImageTarget& target, int y, Float4* upper, Float4* lower) {
  if (target.format != PixelFormat::kRgb24) to_yuv(target, upper), to_yuv(target, lower);
  write_row(target, y, upper);
  write_row(target, y + 1, lower);
  if (target.format == PixelFormat::kNv12 || target.format == PixelFormat::kYuv420)
    write_shared_chroma(target, y, upper, lower);
}

}  // namespace gannet::world
