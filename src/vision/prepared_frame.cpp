#include "src/vision/prepared_frame.hpp"

#include <algorithm>
#include <cstring>

#include "src/vision/hue_value.hpp"
#include "src/vision/yuv_rows.hpp"

namespace gannet::vision {
namespace {

std::size_t area(int width, int height) {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

// Smooths with (1 4 6 4 1)/16 both ways, σ = 1 pixel; edges repeat. The vertical sums of a row
// (at most 16 · 255) are kept in scratch, two pads on each side.
void smooth(const std::uint8_t* from, int width, int height, std::uint16_t* scratch,
            std::uint8_t* to) {
  for (int row = 0; row < height; ++row) {
    const auto line = [&](int r) { return from + std::clamp(r, 0, height - 1) * width; };
    const std::uint8_t *a = line(row - 2), *b = line(row - 1), *c = line(row), *d = line(row + 1),
                       *e = line(row + 2);
    std::uint16_t* sums = scratch + 2;
    for (int i = 0; i < width; ++i) {
      sums[i] = static_cast<std::uint16_t>(a[i] + e[i] + 4 * (b[i] + d[i]) + 6 * c[i]);
    }
    sums[-2] = sums[-1] = sums[0];
    sums[width] = sums[width + 1] = sums[width - 1];
    std::uint8_t* out = to + row * width;
    for (int i = 0; i < width; ++i) {
      out[i] = static_cast<std::uint8_t>(
          (sums[i - 2] + sums[i + 2] + 4 * (sums[i - 1] + sums[i + 1]) + 6 * sums[i] + 128) >> 8);
    }
  }
}

// Means of 2 × 2 pixels; an odd last row or column is left out.
void halve(const std::uint8_t* from, int width, int height, std::uint8_t* to) {
  const int half_width = width / 2;
  for (int row = 0; row < height / 2; ++row) {
    const std::uint8_t* top = from + 2 * row * width;
    const std::uint8_t* bottom = top + width;
    std::uint8_t* out = to + row * half_width;
    for (int i = 0; i < half_width; ++i) {
      out[i] = static_cast<std::uint8_t>(
          (top[2 * i] + top[2 * i + 1] + bottom[2 * i] + bottom[2 * i + 1] + 2) >> 2);
    }
  }
}

// The affine map that spreads a channel's range in this image over 0 … 127. Correlation does not
// see it, and dull images keep their resolution in 7 bits.
struct Stretch {
  std::array<std::uint8_t, 256> step;
  float grey_per_step;

  explicit Stretch(const std::vector<std::uint8_t>& channel) {
    const auto [low, high] = std::minmax_element(channel.begin(), channel.end());
    const int first = *low;
    const int range = std::max(*high - first, 16);
    grey_per_step = static_cast<float>(range) / 127.0f;
    for (int i = 0; i < 256; ++i) {
      const int x = ((i - first) * 254 + range) / (2 * range);
      step[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::clamp(x, 0, 127));
    }
  }
};

}  // namespace

PreparedFrame::PreparedFrame(int width, int height, PlaneNeeds needs)
    : width_(width), height_(height), needs_(needs) {
  for (auto& channel : raw_) channel.resize(area(width, height) + 2);
  scratch_.resize(static_cast<std::size_t>(width) + 4);
  for (std::size_t eye = 0; eye < 2; ++eye) {
    EyePlanes& planes = eyes_[eye];
    Buffers& buffers = buffers_[eye];
    planes.width = width;
    planes.height = height;
    for (std::size_t l = 0; l < kLevels; ++l) {
      const int w = width >> l;
      const int h = height >> l;
      for (auto& channel : buffers.level[l]) channel.resize(area(w, h));
      buffers.packed[l].resize(area(w, h) + kSpareCells);
      planes.packed[l] = {buffers.packed[l].data(), w, h, w * h};
    }
    for (std::size_t c = 0; c < 3; ++c) planes.smooth[c] = buffers.level[0][c].data();
    if (!needs.hue_value) continue;
    buffers.hue_value.resize(area(width, height) + kSpareCells);
    planes.hue_value = buffers.hue_value.data();
    hue_value_table();
  }
}

bool PreparedFrame::prepare(const hal::ImageView& left, const hal::ImageView& right) {
  for (const hal::ImageView* view : {&left, &right}) {
    if (view->width != width_ || view->height != height_) return false;
  }
  prepare_eye(left, buffers_[0], eyes_[0]);
  prepare_eye(right, buffers_[1], eyes_[1]);
  return true;
}

void PreparedFrame::prepare_eye(const hal::ImageView& image, Buffers& buffers, EyePlanes& planes) {
  for (int row = 0; row < height_; ++row) {
    const std::size_t at = area(row, width_);
    unpack_row(image, row, raw_[0].data() + at, raw_[1].data() + at, raw_[2].data() + at);
  }
  for (std::size_t c = 0; c < 3; ++c) {
    smooth(raw_[c].data(), width_, height_, scratch_.data(), buffers.level[0][c].data());
  }
  if (needs_.hue_value) {
    const HueValueTable& table = hue_value_table();
    const auto& [y, u, v] = buffers.level[0];
    for (std::size_t i = 0; i < y.size(); ++i) buffers.hue_value[i] = table.cell(y[i], u[i], v[i]);
  }
  if (needs_.packed) pack(buffers, planes);
}

void PreparedFrame::pack(Buffers& buffers, EyePlanes& planes) {
  for (std::size_t l = 1; l < kLevels; ++l) {
    const int w = width_ >> (l - 1);
    const int h = height_ >> (l - 1);
    for (std::size_t c = 0; c < 3; ++c) {
      halve(buffers.level[l - 1][c].data(), w, h, raw_[0].data());
      smooth(raw_[0].data(), w / 2, h / 2, scratch_.data(), buffers.level[l][c].data());
    }
  }
  // The range of the half-size image: noise of single pixels does not widen it.
  const std::array<Stretch, 3> stretch = {
      Stretch(buffers.level[1][0]), Stretch(buffers.level[1][1]), Stretch(buffers.level[1][2])};
  for (std::size_t c = 0; c < 3; ++c) planes.grey_per_step[c] = stretch[c].grey_per_step;
  for (std::size_t l = 0; l < kLevels; ++l) {
    const auto& [y, u, v] = buffers.level[l];
    std::uint32_t* out = buffers.packed[l].data();
    for (std::size_t i = 0; i < y.size(); ++i) {
      out[i] = std::uint32_t{stretch[0].step[y[i]]} | std::uint32_t{stretch[1].step[u[i]]} << 8 |
               std::uint32_t{stretch[2].step[v[i]]} << 16 | 1u << 24;
    }
  }
}

}  // namespace gannet::vision
