#include "src/vision/yuv_rows.hpp"

#include <cstring>

namespace gannet::vision {
namespace {

using hal::ColourMatrix;
using hal::ColourRange;
using hal::ImageView;
using hal::PixelFormat;

std::uint8_t clamp_byte(int x) { return static_cast<std::uint8_t>(x < 0 ? 0 : x > 255 ? 255 : x); }

void unpack_packed(const std::uint8_t* p, int width, int luma, std::uint8_t* y, std::uint8_t* u,
                   std::uint8_t* v) {
  const int chroma = 1 - luma;
  for (int i = 0; i < width / 2; ++i) {
    y[2 * i] = p[4 * i + luma];
    y[2 * i + 1] = p[4 * i + 2 + luma];
    u[2 * i] = u[2 * i + 1] = p[4 * i + chroma];
    v[2 * i] = v[2 * i + 1] = p[4 * i + 2 + chroma];
  }
}

void widen_chroma(const std::uint8_t* from, int step, int width, std::uint8_t* to) {
  for (int i = 0; i < (width + 1) / 2; ++i) to[2 * i] = to[2 * i + 1] = from[step * i];
}

// RGB → full-range BT.601 in 16-bit fixed point; each line of factors sums to 65536 or 0.
void unpack_rgb(const std::uint8_t* p, int width, std::uint8_t* y, std::uint8_t* u,
                std::uint8_t* v) {
  for (int i = 0; i < width; ++i) {
    const int r = p[3 * i];
    const int g = p[3 * i + 1];
    const int b = p[3 * i + 2];
    y[i] = clamp_byte((19595 * r + 38470 * g + 7471 * b + 32768) >> 16);
    u[i] = clamp_byte(((-11058 * r - 21710 * g + 32768 * b + 32768) >> 16) + 128);
    v[i] = clamp_byte(((32768 * r - 27439 * g - 5329 * b + 32768) >> 16) + 128);
  }
}

void limited_to_full(int width, std::uint8_t* y, std::uint8_t* u, std::uint8_t* v) {
  for (int i = 0; i < width; ++i) {
    // 255/219 and 255/224 in 1/65536.
    y[i] = clamp_byte(((y[i] - 16) * 76309 + 32768) >> 16);
    u[i] = clamp_byte((((u[i] - 128) * 74606 + 32768) >> 16) + 128);
    v[i] = clamp_byte((((v[i] - 128) * 74606 + 32768) >> 16) + 128);
  }
}

// Full-range BT.709 → full-range BT.601: the product of the two standards' matrices.
void bt709_to_bt601(int width, std::uint8_t* y, std::uint8_t* u, std::uint8_t* v) {
  for (int i = 0; i < width; ++i) {
    const int cb = u[i] - 128;
    const int cr = v[i] - 128;
    y[i] = clamp_byte(y[i] + ((6657 * cb + 12850 * cr + 32768) >> 16));
    u[i] = clamp_byte(((64871 * cb - 7252 * cr + 32768) >> 16) + 128);
    v[i] = clamp_byte(((-4748 * cb + 64447 * cr + 32768) >> 16) + 128);
  }
}

}  // namespace

void unpack_raw_row(const ImageView& image, int row, std::uint8_t* y, std::uint8_t* u,
                    std::uint8_t* v) {
  const int width = image.width;
  const auto line = [&](int plane, int r) { return image.plane[plane] + r * image.stride[plane]; };
  switch (image.format) {
    case PixelFormat::kYuyv:
      unpack_packed(line(0, row), width, 0, y, u, v);
      break;
    case PixelFormat::kUyvy:
      unpack_packed(line(0, row), width, 1, y, u, v);
      break;
    case PixelFormat::kNv12:
      std::memcpy(y, line(0, row), static_cast<std::size_t>(width));
      widen_chroma(line(1, row / 2), 2, width, u);
      widen_chroma(line(1, row / 2) + 1, 2, width, v);
      break;
    case PixelFormat::kYuv422:
    case PixelFormat::kYuv420: {
      const int chroma_row = image.format == PixelFormat::kYuv420 ? row / 2 : row;
      std::memcpy(y, line(0, row), static_cast<std::size_t>(width));
      widen_chroma(line(1, chroma_row), 1, width, u);
      widen_chroma(line(2, chroma_row), 1, width, v);
      break;
    }
    case PixelFormat::kYuv444:
      std::memcpy(y, line(0, row), static_cast<std::size_t>(width));
      std::memcpy(u, line(1, row), static_cast<std::size_t>(width));
      std::memcpy(v, line(2, row), static_cast<std::size_t>(width));
      break;
    case PixelFormat::kRgb24:
      unpack_rgb(line(0, row), width, y, u, v);
      break;
  }
}

void to_full_bt601(const ImageView& image, int count, std::uint8_t* y, std::uint8_t* u,
                   std::uint8_t* v) {
  if (image.format == PixelFormat::kRgb24) return;  // unpacked as such
  if (image.range == ColourRange::kLimited) limited_to_full(count, y, u, v);
  if (image.matrix == ColourMatrix::kBt709) bt709_to_bt601(count, y, u, v);
}

void unpack_row(const ImageView& image, int row, std::uint8_t* y, std::uint8_t* u,
                std::uint8_t* v) {
  unpack_raw_row(image, row, y, u, v);
  to_full_bt601(image, image.width, y, u, v);
}

ImageView columns_of(const ImageView& image, int first, int width) {
  ImageView out = image;
  out.width = width;
  const auto move = [&](std::size_t plane, int bytes) { out.plane[plane] += bytes; };
  switch (image.format) {
    case PixelFormat::kYuyv:
    case PixelFormat::kUyvy:
      move(0, 2 * first);
      break;
    case PixelFormat::kNv12:
      move(0, first);
      move(1, first);
      break;
    case PixelFormat::kYuv422:
    case PixelFormat::kYuv420:
      move(0, first);
      move(1, first / 2);
      move(2, first / 2);
      break;
    case PixelFormat::kYuv444:
      for (const std::size_t plane : {0u, 1u, 2u}) move(plane, first);
      break;
    case PixelFormat::kRgb24:
      move(0, 3 * first);
      break;
  }
  return out;
}

}  // namespace gannet::vision
