#include "src/vision/prepared_frame.hpp"

#include "src/vision/hue_value.hpp"
#include "src/vision/kernels/planes.hpp"
#include "src/vision/yuv_rows.hpp"

namespace gannet::vision {
namespace {

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
      buffers.packed[l].resize(area(w, h) + kSpareCells);
      planes.packed[l] = {
          buffers.packed[l].data(),
          w,
          h,
          w * h,
          {buffers.level[l][0].data(), buffers.level[l][1].data(), buffers.level[l][2].data()}};
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
    kernels_.smooth(raw_[c].data(), width_, height_, scratch_.data(), buffers.level[0][c].data());
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
      kernels_.halve(buffers.level[l - 1][c].data(), w, h, raw_[0].data());
      kernels_.smooth(raw_[0].data(), w / 2, h / 2, scratch_.data(), buffers.level[l][c].data());
    }
  }
  // Correlation does not see an affine map, and dull images keep their resolution in 7 bits. The
  // range of the half-size image: noise of single pixels does not widen it.
  std::array<Stretch, 3> stretch;
  for (std::size_t c = 0; c < 3; ++c) {
    stretch[c] = stretch_of(buffers.level[1][c], kernels_);
    planes.grey_per_step[c] = static_cast<float>(stretch[c].range) / 127.0f;
  }
  for (std::size_t l = 0; l < kLevels; ++l) {
    const auto& [y, u, v] = buffers.level[l];
    const std::uint8_t* const yuv[3] = {y.data(), u.data(), v.data()};
    kernels_.pack(yuv, static_cast<int>(y.size()), stretch.data(), buffers.packed[l].data());
  }
}

}  // namespace gannet::vision
