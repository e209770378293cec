#include "src/world/texture_made.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "platform/base/random.hpp"
#include "src/world/texture.hpp"

namespace gannet::world {
namespace {

using image_file::Raster8;

std::uint8_t byte(double x) { return static_cast<std::uint8_t>(std::clamp(x, 0.0, 255.0) + 0.5); }

// Smooth noise −1 … 1 that repeats after `side`, with one value every `cell` texels.
std::vector<float> octave(int side, int cell, Random& random) {
  const int n = std::max(1, side / cell);
  std::vector<float> grid(static_cast<std::size_t>(n) * static_cast<std::size_t>(n));
  for (float& g : grid) g = 2 * random.uniform_f() - 1;
  const auto value = [&](int x, int y) {
    return grid[static_cast<std::size_t>(y % n) * static_cast<std::size_t>(n) +
                static_cast<std::size_t>(x % n)];
  };
  std::vector<float> out;
  out.reserve(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  for (int y = 0; y < side; ++y) {
    const float ty = static_cast<float>(y % cell) / static_cast<float>(cell);
    const float sy = ty * ty * (3 - 2 * ty);
    for (int x = 0; x < side; ++x) {
      const float tx = static_cast<float>(x % cell) / static_cast<float>(cell);
      const float sx = tx * tx * (3 - 2 * tx);
      const int gx = x / cell, gy = y / cell;
      const float top = value(gx, gy) + (value(gx + 1, gy) - value(gx, gy)) * sx;
      const float low = value(gx, gy + 1) + (value(gx + 1, gy + 1) - value(gx, gy + 1)) * sx;
      out.push_back(top + (low - top) * sy);
    }
  }
  return out;
}

struct Stone {
  float x, y, radius, stretch, tilt;
  std::array<float, 3> colour;
};

std::vector<Stone> stones(int side, Random& random) {
  constexpr std::array<std::array<float, 3>, 5> kColours = {
      {{168, 146, 112}, {130, 118, 100}, {190, 178, 150}, {110, 84, 66}, {96, 104, 96}}};
  std::vector<Stone> all;
  for (int i = 0; i < 700; ++i) {
    const float t = random.uniform_f();
    Stone s{random.uniform_f() * static_cast<float>(side),
            random.uniform_f() * static_cast<float>(side),
            static_cast<float>(side) * (0.012f + 0.045f * t * t * t),
            0.6f + 0.4f * random.uniform_f(),
            3.1416f * random.uniform_f(),
            kColours[static_cast<std::size_t>(random.below(5))]};
    const float light = 0.7f + 0.6f * random.uniform_f();
    for (float& c : s.colour) c *= light;
    all.push_back(s);
  }
  return all;
}

void draw_stone(const Stone& s, Raster8& picture) {
  const int side = picture.width;
  const int reach = static_cast<int>(s.radius) + 2;
  const float c = std::cos(s.tilt), n = std::sin(s.tilt);
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const float fx = static_cast<float>(dx), fy = static_cast<float>(dy);
      const float a = (fx * c + fy * n) / s.radius;
      const float b = (fy * c - fx * n) / (s.radius * s.stretch);
      const float r = std::sqrt(a * a + b * b);
      const float share = std::clamp((1 - r) * s.radius + 0.5f, 0.0f, 1.0f);
      const float round =
          0.55f + 0.45f * std::sqrt(std::max(0.0f, 1 - r * r)) - 0.15f * fy / s.radius;
      const int x = ((static_cast<int>(s.x) + dx) % side + side) % side;
      const int y = ((static_cast<int>(s.y) + dy) % side + side) % side;
      std::uint8_t* p = picture.at(x, y);
      for (std::size_t i = 0; i < 3; ++i) {
        const double over = static_cast<double>(s.colour[i] * round * share) +
                            p[i] * (1.0 - static_cast<double>(share));
        p[i] = byte(over);
      }
    }
  }
}

void add_grain(Raster8& picture, std::uint64_t seed, double strength, bool coloured) {
  Random random(seed);
  for (int cell = 1; cell <= picture.width / 4; cell *= 2) {
    const auto grey = octave(picture.width, cell, random);
    const auto hue = octave(picture.width, cell, random);
    for (std::size_t i = 0; i < grey.size(); ++i) {
      std::uint8_t* p = picture.samples.data() + 3 * i;
      const double g = strength * static_cast<double>(grey[i]);
      const double h = coloured ? strength * static_cast<double>(hue[i]) : 0;
      p[0] = byte(p[0] + g + h), p[1] = byte(p[1] + g), p[2] = byte(p[2] + g - h);
    }
  }
}

}  // namespace

Raster8 pebbles_picture(int side, std::uint64_t seed) {
  Raster8 picture(side, side, 3);
  for (std::size_t i = 0; i < picture.samples.size(); i += 3) {
    picture.samples[i] = 92, picture.samples[i + 1] = 80, picture.samples[i + 2] = 62;
  }
  Random random(seed);
  auto all = stones(side, random);
  std::sort(all.begin(), all.end(),
            [](const Stone& a, const Stone& b) { return a.radius < b.radius; });
  for (const Stone& s : all) draw_stone(s, picture);
  add_grain(picture, seed + 1, 7, false);
  return picture;
}

Raster8 noise_picture(int side, std::uint64_t seed) {
  Raster8 picture(side, side, 3);
  std::fill(picture.samples.begin(), picture.samples.end(), std::uint8_t{128});
  add_grain(picture, seed, 24, true);
  return picture;
}

Raster8 pebbles_tint(int side, std::uint64_t seed) {
  Raster8 picture(side, side, 3);
  Random random(seed);
  for (std::size_t i = 0; i < picture.samples.size(); i += 3) {
    picture.samples[i] = 138, picture.samples[i + 1] = 126, picture.samples[i + 2] = 106;
  }
  for (const int parts : {4, 8, 16, 58}) {  // divisors of the sides in use: it repeats
    const int cell = std::max(1, side / parts);
    const auto light = octave(side, cell, random);
    const auto hue = octave(side, cell, random);
    for (std::size_t i = 0; i < light.size(); ++i) {
      std::uint8_t* p = picture.samples.data() + 3 * i;
      const double l = 12 * static_cast<double>(light[i]), h = 16 * static_cast<double>(hue[i]);
      p[0] = byte(p[0] + l + h), p[1] = byte(p[1] + l), p[2] = byte(p[2] + l - 0.7 * h);
    }
  }
  return picture;
}

// Figures are in parts of the picture's height from the top, and of its half width from the middle.
Raster8 person_picture(std::uint64_t seed) {
  constexpr int kWidth = 186, kHeight = 586;
  struct Part {  // a box with round ends, of two colours that alternate as cloth does
    double middle, top, bottom, half;
    std::array<double, 3> colour, other;
    int across, down;  // texels of a check; 0: none
  };
  const std::array<double, 3> skin = {196, 146, 118}, hair = {58, 40, 30}, shirt = {190, 52, 44},
                              light = {226, 208, 190}, cloth = {52, 66, 104}, seam = {92, 106, 140},
                              shoe = {40, 34, 32}, sole = {210, 206, 198};
  const std::array<Part, 12> parts = {{{-0.28, 0.50, 0.965, 0.24, cloth, seam, 19, 0},
                                       {0.28, 0.50, 0.965, 0.24, cloth, seam, 23, 0},
                                       {-0.30, 0.95, 1.0, 0.30, shoe, sole, 0, 9},
                                       {0.30, 0.95, 1.0, 0.30, shoe, sole, 0, 9},
                                       {-0.80, 0.20, 0.46, 0.17, light, shirt, 0, 21},
                                       {0.80, 0.20, 0.46, 0.17, shirt, light, 0, 27},
                                       {-0.82, 0.44, 0.54, 0.13, skin, skin, 0, 0},
                                       {0.82, 0.44, 0.54, 0.13, skin, skin, 0, 0},
                                       {0.0, 0.12, 0.19, 0.17, skin, skin, 0, 0},
                                       {0.0, 0.165, 0.53, 0.66, shirt, light, 22, 26},
                                       {0.0, 0.02, 0.145, 0.26, skin, skin, 0, 0},
                                       {0.0, 0.0, 0.10, 0.28, hair, skin, 0, 0}}};
  Raster8 picture(kWidth, kHeight, 4);
  Random random(seed);
  const auto coarse = octave(1024, 16, random);
  const auto fine = octave(1024, 4, random);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double across = (x + 0.5) / kWidth * 2 - 1, down = (y + 0.5) / kHeight;
      for (const Part& part : parts) {
        // Texels from the middle line, and into the round ends.
        const double from = std::abs(across - part.middle) * kWidth / 2;
        const double half = part.half * kWidth / 2;
        const double end = std::min(down - part.top, part.bottom - down) * kHeight;
        if (end < 0 || from > half) continue;
        const double round = std::min(12.0, half);
        const double dx = from - (half - round), dy = round - end;
        if (dx > 0 && dy > 0 && dx * dx + dy * dy > round * round) continue;
        const int cells =
            (part.across > 0 ? x / part.across : 0) + (part.down > 0 ? y / part.down : 0);
        const auto& colour = cells % 2 == 0 ? part.colour : part.other;
        const auto i = static_cast<std::size_t>(y) * 1024 + static_cast<std::size_t>(x);
        const double grain =
            22 * static_cast<double>(coarse[i]) + 12 * static_cast<double>(fine[i]);
        std::uint8_t* p = picture.at(x, y);
        for (std::size_t c = 0; c < 3; ++c)
          p[c] = byte(colour[c] * (1 - 0.12 * from / half) + grain);
        p[3] = 255;
      }
    }
  }
  return picture;
}

// Sunlight under waves is a net of bright lines: where a smooth random height crosses zero.
Raster8 caustics_picture() {
  constexpr int kSide = 256;
  Random random(29);
  const auto broad = octave(kSide, 32, random);
  const auto fine = octave(kSide, 16, random);
  Raster8 picture(kSide, kSide, 1);
  for (std::size_t i = 0; i < broad.size(); ++i) {
    const double height = static_cast<double>(broad[i]) + 0.4 * static_cast<double>(fine[i]);
    const double line = 1 - std::min(1.0, 2.2 * std::abs(height));
    picture.samples[i] = byte(255 * srgb_from_linear(0.13 + 0.87 * line * line));
  }
  return picture;
}

}  // namespace gannet::world
