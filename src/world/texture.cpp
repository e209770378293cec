#include "src/world/texture.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>

namespace gannet::world {
namespace {

using image_file::Raster8;

std::size_t index(int x, int y, int width) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
         static_cast<std::size_t>(x);
}

std::vector<Float4> linear_premultiplied(const Raster8& picture) {
  std::vector<Float4> out(index(0, picture.height, picture.width));
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const std::uint8_t* p = picture.at(x, y);
      const float alpha = picture.channels == 4 ? static_cast<float>(p[3]) / 255.0f : 1.0f;
      Float4& texel = out[index(x, y, picture.width)];
      for (int c = 0; c < 3; ++c) {
        const std::uint8_t code = p[picture.channels >= 3 ? c : 0];
        texel[c] = alpha * linear_from_srgb(static_cast<float>(code) / 255.0f);
      }
      texel[3] = alpha;
    }
  }
  return out;
}

// The four weights of Catmull–Rom at t between the second and the third sample.
std::array<float, 4> catmull_rom(float t) {
  return {((-0.5f * t + 1.0f) * t - 0.5f) * t, (1.5f * t - 2.5f) * t * t + 1.0f,
          ((-1.5f * t + 2.0f) * t + 0.5f) * t, (0.5f * t - 0.5f) * t * t};
}

int neighbour(int i, int size, Texture::Edge edge) {
  return edge == Texture::Edge::kTile ? ((i % size) + size) % size : std::clamp(i, 0, size - 1);
}

// Enlarges rows of `count` lines from `from` to `to` samples each. step and line are the distances
// of samples and of lines in both arrays' own strides.
std::vector<Float4> enlarge_rows(const std::vector<Float4>& in, int from, int to, int lines,
                                 Texture::Edge edge) {
  if (from == to) return in;
  std::vector<Float4> out(index(0, lines, to));
  for (int x = 0; x < to; ++x) {
    const float at =
        (static_cast<float>(x) + 0.5f) * static_cast<float>(from) / static_cast<float>(to) - 0.5f;
    const int x0 = floor_int(at);
    const auto weight = catmull_rom(at - static_cast<float>(x0));
    for (int y = 0; y < lines; ++y) {
      Float4 sum = splat(0);
      for (int k = 0; k < 4; ++k) {
        sum += in[index(neighbour(x0 - 1 + k, from, edge), y, from)] *
               weight[static_cast<std::size_t>(k)];
      }
      out[index(x, y, to)] = sum;
    }
  }
  return out;
}

std::vector<Float4> transposed(const std::vector<Float4>& in, int width, int height) {
  std::vector<Float4> out(in.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) out[index(y, x, height)] = in[index(x, y, width)];
  return out;
}

std::vector<Float4> enlarged(const std::vector<Float4>& in, int width, int height, int new_width,
                             int new_height, Texture::Edge edge) {
  auto wide = enlarge_rows(in, width, new_width, height, edge);
  auto columns = transposed(wide, new_width, height);
  auto tall = enlarge_rows(columns, height, new_height, new_width, edge);
  auto out = transposed(tall, new_height, new_width);
  for (Float4& texel : out) {  // Catmull–Rom overshoots at sharp edges
    const Float4 top = splat(std::clamp(texel[3], 0.0f, 1.0f));
    texel = min4(max4(texel, splat(0)), top);
  }
  return out;
}

std::vector<Float4> halved(const std::vector<Float4>& in, int width, int height) {
  const int w = std::max(1, width / 2);
  const int h = std::max(1, height / 2);
  const int dx = width > 1 ? 1 : 0;
  const int dy = height > 1 ? 1 : 0;
  std::vector<Float4> out(index(0, h, w));
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      const int x0 = dx ? 2 * x : 0;
      const int y0 = dy ? 2 * y : 0;
      out[index(x, y, w)] = ((in[index(x0, y0, width)] + in[index(x0 + dx, y0, width)]) +
                             (in[index(x0, y0 + dy, width)] + in[index(x0 + dx, y0 + dy, width)])) *
                            0.25f;
    }
  }
  return out;
}

int power_of_two(int side) {
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(1, side))));
}

}  // namespace

float linear_from_srgb(float code) {
  return code <= 0.04045f ? code / 12.92f : std::pow((code + 0.055f) / 1.055f, 2.4f);
}

double srgb_from_linear(double light) {
  const double x = std::clamp(light, 0.0, 1.0);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

Texture::Texture(const Raster8& picture, Edge edge) : edge_(edge) {
  assert(picture.width >= 1 && picture.height >= 1);
  int width = power_of_two(picture.width);
  int height = power_of_two(picture.height);
  std::vector<Float4> texels =
      enlarged(linear_premultiplied(picture), picture.width, picture.height, width, height, edge);
  while (true) {
    add_level(width, height, texels);
    if (width == 1 && height == 1) break;
    texels = halved(texels, width, height);
    width = std::max(1, width / 2);
    height = std::max(1, height / 2);
  }
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const TextureLevel& a = levels_[i];
    const TextureLevel& b = levels_[std::min(i + 1, levels_.size() - 1)];
    scale_.push_back(Float4{static_cast<float>(a.width), static_cast<float>(a.height),
                            static_cast<float>(b.width), static_cast<float>(b.height)});
  }
}

void Texture::add_level(int width, int height, const std::vector<Float4>& texels) {
  TextureLevel level;
  level.width = width;
  level.height = height;
  level.stride = width + 2;
  level.first = texels_.size();
  for (int y = -1; y <= height; ++y) {
    for (int x = -1; x <= width; ++x) {
      texels_.push_back(
          texels[index(neighbour(x, width, edge_), neighbour(y, height, edge_), width)]);
    }
  }
  levels_.push_back(level);
}

}  // namespace gannet::world
