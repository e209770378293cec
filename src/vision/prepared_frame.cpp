#include "src/vision/prepared_frame.hpp"

#include <algorithm>

#include "src/vision/hue_value.hpp"
#include "src/vision/yuv_rows.hpp"

namespace gannet::vision {
namespace {

using hal::PixelFormat;

std::size_t area(int width, int height) {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

Stretch stretch_of(const std::vector<std::uint8_t>& channel, const PlaneKernels& kernels) {
  std::uint8_t low = 0, high = 0;
  if (!channel.empty()) {
    kernels.limits(channel.data(), static_cast<int>(channel.size()), &low, &high);
  }
  return Stretch::between(low, high);
}

}  // namespace

PreparedFrame::PreparedFrame(int width, int height, PlaneNeeds needs)
    : width_(width), height_(height), needs_(needs), kernels_(plane_kernels()) {
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
      if (l > 0) {
        for (auto& channel : buffers.means[l]) channel.resize(area(w, h));
      }
      buffers.packed[l].resize(area(w, h) + kSpareCells);
      const auto& [y, u, v] = buffers.level[l];
      planes.packed[l] = {buffers.packed[l].data(), w, h, w * h, {y.data(), u.data(), v.data()}};
    }
    planes.smooth = planes.packed[0].smooth;
    if (!needs.hue_value) continue;
    buffers.hue_value.resize(area(width, height) + kSpareCells);
    planes.hue_value = buffers.hue_value.data();
    hue_value_table();
  }
}

bool PreparedFrame::fits(const hal::ImageView& left, const hal::ImageView& right) const {
  const auto fits = [this](const hal::ImageView& view) {
    return view.width == width_ && view.height == height_;
  };
  return fits(left) && fits(right);
}

bool PreparedFrame::prepare(const hal::ImageView& left, const hal::ImageView& right) {
  if (needs_.packed ? !prepare_coarse(left, right, 1) : !fits(left, right)) return false;
  const Region whole = {0, 0, width_, height_};
  prepare_fine(left, right, whole, whole);
  return true;
}

bool PreparedFrame::prepare_coarse(const hal::ImageView& left, const hal::ImageView& right,
                                   int finest) {
  if (!fits(left, right)) return false;
  for (std::size_t eye = 0; eye < 2; ++eye) {
    make_means(eye == 0 ? left : right, buffers_[eye], eyes_[eye]);
    for (int l = finest; l < kLevels; ++l) finish_level(l, buffers_[eye]);
  }
  return true;
}

void PreparedFrame::prepare_fine(const hal::ImageView& left, const hal::ImageView& right,
                                 const Region& in_left, const Region& in_right) {
  finish_region(left, in_left, buffers_[0]);
  finish_region(right, in_right, buffers_[1]);
}

// Two rows at a time, so that no full-size copy is made.
void PreparedFrame::halve_image(const hal::ImageView& image, Buffers& buffers) {
  const int half = width_ / 2;
  const bool packed = image.format == PixelFormat::kYuyv || image.format == PixelFormat::kUyvy;
  for (int row = 0; row < height_ / 2; ++row) {
    const std::size_t at = area(row, half);
    std::uint8_t* const to[3] = {buffers.means[1][0].data() + at, buffers.means[1][1].data() + at,
                                 buffers.means[1][2].data() + at};
    if (packed) {
      const std::uint8_t* const top = image.plane[0] + 2 * row * image.stride[0];
      kernels_.halve_packed(top, top + image.stride[0], half,
                            image.format == PixelFormat::kYuyv ? 0 : 1, to[0], to[1], to[2]);
      continue;
    }
    for (const int k : {0, 1}) {
      const std::size_t line = area(k, width_);
      unpack_raw_row(image, 2 * row + k, raw_[0].data() + line, raw_[1].data() + line,
                     raw_[2].data() + line);
    }
    for (std::size_t c = 0; c < 3; ++c) kernels_.halve(raw_[c].data(), width_, 2, to[c]);
  }
  to_full_bt601(image, static_cast<int>(buffers.means[1][0].size()), buffers.means[1][0].data(),
                buffers.means[1][1].data(), buffers.means[1][2].data());
}

void PreparedFrame::make_means(const hal::ImageView& image, Buffers& buffers, EyePlanes& planes) {
  halve_image(image, buffers);
  for (std::size_t l = 2; l < kLevels; ++l) {
    for (std::size_t c = 0; c < 3; ++c) {
      kernels_.halve(buffers.means[l - 1][c].data(), width_ >> (l - 1), height_ >> (l - 1),
                     buffers.means[l][c].data());
    }
  }
  // Correlation does not see an affine map, and dull images keep their resolution in 7 bits. The
  // range of means: noise of single pixels does not widen it.
  for (std::size_t c = 0; c < 3; ++c) {
    buffers.stretch[c] = stretch_of(buffers.means[2][c], kernels_);
    planes.grey_per_step[c] = static_cast<float>(buffers.stretch[c].range) / 127.0f;
  }
}

void PreparedFrame::finish_level(int level, Buffers& buffers) {
  const auto l = static_cast<std::size_t>(level);
  const int w = width_ >> level;
  for (std::size_t c = 0; c < 3; ++c) {
    kernels_.smooth(buffers.means[l][c].data(), w, height_ >> level, scratch_.data(),
                    buffers.level[l][c].data(), w);
  }
  const auto& [y, u, v] = buffers.level[l];
  const std::uint8_t* const yuv[3] = {y.data(), u.data(), v.data()};
  kernels_.pack(yuv, static_cast<int>(y.size()), buffers.stretch.data(), buffers.packed[l].data());
}

// Smoothing reaches two pixels beyond what it is asked for.
void PreparedFrame::finish_region(const hal::ImageView& image, const Region& region,
                                  Buffers& buffers) {
  constexpr int kReach = 2;
  const int left = std::max(region.left - kReach, 0) / 16 * 16;
  const int right = std::min(std::max(region.right + kReach, 0) / 16 * 16 + 16, width_);
  const int top = std::max(region.top - kReach, 0);
  const int bottom = std::min(region.bottom + kReach, height_);
  if (left >= right || top >= bottom) return;
  const int w = right - left;
  const hal::ImageView part = columns_of(image, left, w);
  for (int row = top; row < bottom; ++row) {
    const std::size_t at = area(row - top, w);
    unpack_row(part, row, raw_[0].data() + at, raw_[1].data() + at, raw_[2].data() + at);
  }
  const std::size_t first = area(top, width_) + static_cast<std::size_t>(left);
  for (std::size_t c = 0; c < 3; ++c) {
    kernels_.smooth(raw_[c].data(), w, bottom - top, scratch_.data(),
                    buffers.level[0][c].data() + first, width_);
  }
  const auto& [y, u, v] = buffers.level[0];
  for (int row = top; row < bottom; ++row) {
    const std::size_t at = area(row, width_) + static_cast<std::size_t>(left);
    if (needs_.packed) {
      const std::uint8_t* const yuv[3] = {y.data() + at, u.data() + at, v.data() + at};
      kernels_.pack(yuv, w, buffers.stretch.data(), buffers.packed[0].data() + at);
    }
    if (!needs_.hue_value) continue;
    const HueValueTable& table = hue_value_table();
    for (std::size_t i = at; i < at + static_cast<std::size_t>(w); ++i) {
      buffers.hue_value[i] = table.cell(y[i], u[i], v[i]);
    }
  }
}

}  // namespace gannet::vision
