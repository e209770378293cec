// Image: an image that owns its bytes, and the one place that knows how each PixelFormat lies in
// memory. Used by files, models, tests and the camera kinds' slots; heap only when created.
// Any thread; the caller owns the image.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/camera/image_view.hpp"

namespace gannet::hal {

inline constexpr int kMaxImageSide = 16384;  // pixels; what a file or header says beyond is refused

// How a format lies in one block of bytes: planes start at multiples of 64 bytes, rows are tight.
struct ImageLayout {
  int planes = 0;
  std::array<std::size_t, 3> offset = {};  // bytes from the block's start
  std::array<int, 3> stride = {};          // bytes from one row to the next
  std::array<int, 3> rows = {};
  std::size_t bytes = 0;  // of the block, a multiple of 64; 0: the size does not suit the format
};

// bytes is 0 for sides outside 1 … kMaxImageSide and for odd sides of a subsampled format. RT safe.
ImageLayout layout_of(PixelFormat format, int width, int height);

// A view of a block laid out so; base must have room for layout.bytes. RT safe.
ImageView view_of(const ImageLayout& layout, const std::uint8_t* base, PixelFormat format,
                  int width, int height, ColourMatrix matrix, ColourRange range);

const char* to_string(PixelFormat format);  // "yuyv" … "rgb24", as in the config; RT safe

class Image {
 public:
  Image() = default;
  // Zeroed bytes. An unsuitable size (layout_of) is a bug of the caller.
  Image(int width, int height, PixelFormat format, ColourMatrix matrix = ColourMatrix::kBt601,
        ColourRange range = ColourRange::kFull);

  bool empty() const { return bytes_.empty(); }
  int width() const { return width_; }
  int height() const { return height_; }
  PixelFormat format() const { return format_; }
  const ImageLayout& layout() const { return layout_; }
  ImageView view() const;  // valid while this image lives and is not assigned

  std::uint8_t* plane(int index) { return bytes_.data() + layout_.offset[at(index)]; }
  const std::uint8_t* plane(int index) const { return bytes_.data() + layout_.offset[at(index)]; }
  std::uint8_t* row(int index, int y) { return plane(index) + offset_of_row(index, y); }
  const std::uint8_t* row(int index, int y) const { return plane(index) + offset_of_row(index, y); }
  int stride(int index) const { return layout_.stride[at(index)]; }
  std::span<std::uint8_t> bytes() { return bytes_; }
  std::span<const std::uint8_t> bytes() const { return bytes_; }

 private:
  static std::size_t at(int index) { return static_cast<std::size_t>(index); }
  std::ptrdiff_t offset_of_row(int index, int y) const {
    return std::ptrdiff_t{y} * layout_.stride[at(index)];
  }

  int width_ = 0;
  int height_ = 0;
  PixelFormat format_ = PixelFormat::kRgb24;
  ColourMatrix matrix_ = ColourMatrix::kBt601;
  ColourRange range_ = ColourRange::kFull;
  ImageLayout layout_;
  std::vector<std::uint8_t> bytes_;
};

// Whether the view's planes, strides and sides fit its format, so that all its pixels may be read
// (how many bytes are behind the pointers it cannot know). RT safe.
bool is_complete(const ImageView& view);

// The same pixels in an image of our own layout.
Image copy_of(const ImageView& view);

// Any view as full-range BT.601 planar 4:4:4 (chroma repeated, not interpolated), as models store.
Image to_yuv444(const ImageView& view);

// Any view as RGB24 for people, by the view's own matrix and range.
Image to_rgb24(const ImageView& view);

}  // namespace gannet::hal
