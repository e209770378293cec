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
  std::size_t first = 0;  // index of the border's corner, texel (−1, −1)
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

  // place: u, v, u, v in [0, 1] of the whole picture. level may lie between two levels
  // (trilinear); below 0 is 0. Returns premultiplied linear R, G, B and alpha, 0 … 1.
  Float4 sample(Float4 place, float level) const;
  Float4 sample(float u, float v, float level) const { return sample(Float4{u, v, u, v}, level); }
  Float4 mean() const { return texels_.back(); }

 private:
  Float4 bilinear(const TextureLevel& level, int x, int y, float fx, float fy) const;
  void add_level(int width, int height, const std::vector<Float4>& texels);

  Edge edge_;
  std::vector<TextureLevel> levels_;
  std::vector<Float4> scale_;  // width, height of a level and of the next
  std::vector<Float4> texels_;
};

inline Float4 Texture::bilinear(const TextureLevel& level, int x, int y, float fx, float fy) const {
  const Float4* a = texels_.data() + level.first + std::ptrdiff_t{y} * level.stride + x;
  const Float4* b = a + level.stride;
  const Float4 top = a[0] + (a[1] - a[0]) * fx;
  const Float4 bottom = b[0] + (b[1] - b[0]) * fx;
  return top + (bottom - top) * fy;
}

// Counted from the border's corner a place is positive, so that truncation is the floor.
inline Float4 Texture::sample(Float4 place, float level) const {
  const int last = levels() - 1;
  const int fine = level <= 0                          ? 0
                   : level >= static_cast<float>(last) ? last
                                                       : static_cast<int>(level);
  const auto i = static_cast<std::size_t>(fine);
  const Float4 at = place * scale_[i] + splat(0.5f);
  const Int4 whole = __builtin_convertvector(at, Int4);
  const Float4 part = at - __builtin_convertvector(whole, Float4);
  const Float4 a = bilinear(levels_[i], whole[0], whole[1], part[0], part[1]);
  if (level <= 0 || fine == last) return a;
  const Float4 b = bilinear(levels_[i + 1], whole[2], whole[3], part[2], part[3]);
  return a + (b - a) * (level - static_cast<float>(fine));
}

float linear_from_srgb(float code);     // 0 … 1 both
double srgb_from_linear(double light);  // clamped to 0 … 1

}  // namespace gannet::world
