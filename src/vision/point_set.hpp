// PointSet: a patch model at one level of detail, laid out for the kernels: coordinates padded with
// NaN, colours as hue bytes, hue–value cells and 7-bit correlation blocks. assign() reuses memory:
// RT safe once reserve() has been called for as many points.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "src/vision/patch_model.hpp"

namespace gannet::vision {

struct PointSet {
  int inside = 0;         // S_in points
  int outside = 0;        // S_out points
  int core = 0;           // of S_in, first: without border (rounded down to whole lanes)
  int inside_padded = 0;  // S_out starts here
  int total_padded = 0;

  float reach = 0;       // of any point from (0, 0)
  std::vector<float> x;  // metres on the plane (or ray coordinates)
  std::vector<float> y;
  std::vector<float> z;     // empty: flat; else metres behind the plane, for the refinement alone
  std::vector<Yuv> colour;  // S_out: the background's mean
  std::vector<std::uint8_t> hue;            // S_in
  std::vector<std::uint8_t> is_background;  // 0xFF where S_in's hue is near the background's
  std::vector<std::uint16_t> hue_value;     // all points, their own
  std::vector<std::int8_t> correlation;     // blocks of 16 bytes for four points
  std::array<std::int32_t, 3> sum = {};     // Σ and Σ² of the correlation values per channel
  std::array<std::int32_t, 3> sum_squares = {};
  std::array<std::int32_t, 3> inside_sum = {};  // of S_in alone
  std::array<std::int32_t, 3> inside_squares = {};
  std::array<float, 3> grey_per_step = {1, 1, 1};

  int points() const { return inside + outside; }
  void reserve(int max_points);
  // own_outside: S_out keeps its own colours (Pb3DP) instead of the background's mean.
  void assign(const std::vector<ModelPoint>& points, const Yuv& background,
              std::uint8_t background_hue, bool own_outside);
};

// Merges the points into cells of factor × spacing, S_in and S_out apart: the coarser model.
// out is cleared and filled; RT safe when it has the capacity. factor 1 copies.
void coarsen(const std::vector<ModelPoint>& points, double spacing, double factor,
             std::vector<ModelPoint>& out);

}  // namespace gannet::vision
