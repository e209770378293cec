// PreparedFrame: what the fitness functions look at, made once per image pair: for each eye a
// pyramid of packed cells (Y, U, V stretched to 7 bits, and a 1) with the smoothed bytes, and,
// where asked for, a plane of (hue, value) cells. All at once, or in two steps for who knows where
// to look: the coarse levels everywhere, then the finest where it is wanted; the bytes are the
// same. Memory is taken at creation. Owner: whoever recognises (the vision thread). Preparing is RT
// safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hal/camera/image_view.hpp"
#include "src/vision/kernels/planes.hpp"

namespace gannet::vision {

constexpr int kLevels = 4;  // each half the size of the one before
// Cells behind the last one: the guard, and what a 32-bit read at a 16-bit cell may touch.
constexpr std::size_t kSpareCells = 16;

struct PlaneNeeds {
  bool packed = false;
  bool hue_value = false;
};

// Pixels [left, right) × [top, bottom) of a full-size image.
struct Region {
  int left = 0, top = 0, right = 0, bottom = 0;
};

// One level of one eye. Pixel (u, v) of the camera is (u + 0.5) / 2^level − 0.5 here.
struct PackedPlane {
  const std::uint32_t* cells = nullptr;
  int width = 0;
  int height = 0;
  int guard = 0;  // index of the cell outside; also the number of cells
  std::array<const std::uint8_t*, 3> smooth = {};  // the same as bytes: Y U V, σ ≈ 1 of its pixels
};

struct EyePlanes {
  std::array<PackedPlane, kLevels> packed;
  // Grey levels per step of the 7-bit cells, Y U V: the correlation's floors are in grey levels.
  std::array<float, 3> grey_per_step = {1, 1, 1};
  const std::uint16_t* hue_value = nullptr;        // full size, guard behind the last cell
  std::array<const std::uint8_t*, 3> smooth = {};  // Y U V at full size, σ ≈ 1 pixel
  int width = 0;
  int height = 0;
};

class PreparedFrame {
 public:
  PreparedFrame(int width, int height, PlaneNeeds needs);

  // Both views must have the size given at creation; false and unchanged otherwise.
  bool prepare(const hal::ImageView& left, const hal::ImageView& right);

  // The levels from `finest` (at least 1) upwards; the finer ones are stale then.
  bool prepare_coarse(const hal::ImageView& left, const hal::ImageView& right, int finest);
  // Level 0 where these regions are, clipped to the image; elsewhere it is stale.
  void prepare_fine(const hal::ImageView& left, const hal::ImageView& right, const Region& in_left,
                    const Region& in_right);

  const EyePlanes& left() const { return eyes_[0]; }
  const EyePlanes& right() const { return eyes_[1]; }

 private:
  struct Buffers {
    // Y U V: means of 2^level × 2^level pixels (from level 1), and these smoothed.
    std::array<std::array<std::vector<std::uint8_t>, 3>, kLevels> means, level;
    std::array<std::vector<std::uint32_t>, kLevels> packed;
    std::vector<std::uint16_t> hue_value;
    std::array<Stretch, 3> stretch = {};
  };

  bool fits(const hal::ImageView& left, const hal::ImageView& right) const;
  void make_means(const hal::ImageView& image, Buffers& buffers, EyePlanes& planes);
  void halve_image(const hal::ImageView& image, Buffers& buffers);
  void finish_level(int level, Buffers& buffers);
  void finish_region(const hal::ImageView& image, const Region& region, Buffers& buffers);

  int width_;
  int height_;
  PlaneNeeds needs_;
  const PlaneKernels& kernels_;
  std::array<Buffers, 2> buffers_;
  std::array<EyePlanes, 2> eyes_;
  std::array<std::vector<std::uint8_t>, 3> raw_;  // Y U V before smoothing
  std::vector<std::uint16_t> scratch_;            // one filtered row
};

}  // namespace gannet::vision
