// Texture: a picture on a plane, ready to be looked at from anywhere: linear light, alpha
// premultiplied, sides powers of two, a pyramid of box-filtered halves. Every level has a border of
// one texel (repeated or wrapped), so that a bilinear look-up needs no branch. Pictures with other
// sides are enlarged with Catmull–Rom, which keeps every centroid where it was.
// Made at start-up (heap); reading from any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/image_file/raster.hpp"
#include "src/world/simd.hpp"

namespace gannet::world {

struct TextureLevel {
  int width = 0;
  int height = 0;
  std::size_t first = 0;  // texel (0, 0) in texels; the border lies before it
  int stride = 0;         // texels from one row to the next
};

class Texture {
 public:
  enum class Edge { kClamp, kTile };

  // sRGB codes (IEC 61966-2-1) with 1, 3 or 4 channels, alpha straight; sides 1 … 4096.
  Texture(const image_file::Raster8& picture, Edge edge);

  bool tiled() const { return edge_ == Edge::kTile; }
  int width() const { return levels_.front().width; }
  int height() const { return levels_.front().height; }
  int levels() const { return static_cast<int>(levels_.size()); }

  // u, v in [0, 1] of the whole picture. level >= 0 may lie between two levels (trilinear).
  // Returns premultiplied linear R, G, B and alpha, 0 … 1.
  Float4 sample(float u, float v, float level) const;
  Float4 mean() const { return texels_[levels_.back().first]; }

 private:
  Float4 bilinear(const TextureLevel& level, float u, float v) const;
  void add_level(int width, int height, const std::vector<Float4>& texels);

  Edge edge_;
  std::vector<TextureLevel> levels_;
  std::vector<Float4> texels_;
};

inline Float4 Texture::bilinear(const TextureLevel& level, float u, float v) const {
  const float x = u * static_cast<float>(level.width) - 0.5f;
  const float y = v * static_cast<float>(level.height) - 0.5f;
  const int x0 = floor_int(x);
  const int y0 = floor_int(y);
  const float fx = x - static_cast<float>(x0);
  const float fy = y - static_cast<float>(y0);
  const Float4* a = texels_.data() + level.first + std::ptrdiff_t{y0} * level.stride + x0;
  const Float4* b = a + level.stride;
  const Float4 top = a[0] + (a[1] - a[0]) * fx;
  const Float4 bottom = b[0] + (b[1] - b[0]) * fx;
  return top + (bottom - top) * fy;
}

inline Float4 Texture::sample(float u, float v, float level) const {
  if (level <= 0) return bilinear(levels_.front(), u, v);
  const int fine = static_cast<int>(level);
  if (fine + 1 >= levels()) return bilinear(levels_.back(), u, v);
  const auto at = static_cast<std::size_t>(fine);
  const Float4 a = bilinear(levels_[at], u, v);
  const Float4 b = bilinear(levels_[at + 1], u, v);
  return a + (b - a) * (level - static_cast<float>(fine));
}

float linear_from_srgb(float code);     // 0 … 1 both
double srgb_from_linear(double light);  // clamped to 0 … 1

}  // namespace gannet::world
