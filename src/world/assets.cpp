#include "src/world/assets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "src/image_file/image_file.hpp"
#include "src/world/texture_made.hpp"

namespace gannet::world {
namespace {

using image_file::Raster8;

// Sizes: P001 Fig. 5 (C01 … C06), P000 §3.2 (crab, starfish), P004 §4.1 (person).
constexpr std::array<Creature, 10> kCreatures = {{
    {"crab", "butterflyfish.png", "copperband butterflyfish", true, 0.185, 0.130},
    {"starfish", "lionfish.png", "lionfish from above, fins spread", true, 0.073, 0.073},
    {"seahorse", "seahorse.png", "seahorse", false, 0.045, 0.130},
    {"coelacanth", "bluegroper.png", "blue groper", true, 0.145, 0.070},
    {"dolphin", "dolphin.png", "dolphin", false, 0.080, 0.060},
    {"jellyfish", "abalone.png", "abalone shell", true, 0.090, 0.110},
    {"crab_p001", "butterflyfish.png", "copperband butterflyfish", true, 0.175, 0.140},
    {"squid", "coraltrout.png", "coral trout", true, 0.210, 0.0825},
    {"lobster", "lobster.png", "spiny lobster", false, 0.200, 0.190},
    {"person", "fireman.png", "a fireman (another person than theirs)", false, 0.5572, 1.756},
}};

std::size_t index(int x, int y, int side) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x);
}

// Fades the last `overlap` columns into the first ones so that the picture repeats; then turned,
// it does the rows.
std::vector<float> seamless_columns(const std::vector<float>& in, int width, int height,
                                    int overlap) {
  const int out_width = width - overlap;
  std::vector<float> out(index(0, height, out_width));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < out_width; ++x) {
      float value = in[index(x, y, width)];
      if (x < overlap) {
        // Weights on a circle keep the contrast of two unlike pictures, where a plain fade greys.
        const float t = (static_cast<float>(x) + 0.5f) / static_cast<float>(overlap);
        const float a = std::sqrt(t), b = std::sqrt(1 - t);
        value = 128 + a * (value - 128) + b * (in[index(out_width + x, y, width)] - 128);
      }
      out[index(x, y, out_width)] = value;
    }
  }
  return out;
}

std::vector<float> turned(const std::vector<float>& in, int width, int height) {
  std::vector<float> out(in.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) out[index(y, x, height)] = in[index(x, y, width)];
  return out;
}

}  // namespace

std::span<const Creature> creatures() { return kCreatures; }

const Creature* find_creature(std::string_view name) {
  const auto it = std::find_if(kCreatures.begin(), kCreatures.end(),
                               [&](const Creature& c) { return c.name == name; });
  return it == kCreatures.end() ? nullptr : &*it;
}

std::string assets_folder() {
  const char* set = std::getenv("GANNET_ASSETS");
  if (set != nullptr) return set;
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  const auto installed = (program / "../share/gannet/assets").lexically_normal();
  return std::filesystem::exists(installed, error) ? installed.string() : "build/assets";
}

bool assets_present(const std::string& folder) {
  return std::all_of(kCreatures.begin(), kCreatures.end(), [&](const Creature& c) {
    return std::filesystem::exists(folder + "/" + std::string(c.picture));
  });
}

Raster8 cut_to_silhouette(const Raster8& picture) {
  int left = picture.width, right = -1, top = picture.height, bottom = -1;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      if (picture.channels == 4 && picture.at(x, y)[3] < 128) continue;
      left = std::min(left, x), right = std::max(right, x);
      top = std::min(top, y), bottom = std::max(bottom, y);
    }
  }
  if (right < left) return picture;
  Raster8 out(right - left + 1, bottom - top + 1, picture.channels);
  for (int y = 0; y < out.height; ++y) {
    const std::uint8_t* row = picture.at(left, top + y);
    std::copy(row, row + out.width * out.channels, out.at(0, y));
  }
  return out;
}

Result<Raster8> read_stamp(const std::string& path) {
  auto picture = image_file::read_png_rgba(path);
  if (!picture) return picture.error();
  return cut_to_silhouette(*picture);
}

Result<Raster8> read_gravel(const std::string& path) {
  const auto read = image_file::read_png_rgba(path);
  if (!read) return read.error();
  const Raster8& picture = *read;
  constexpr int kOverlap = 48;
  if (picture.width <= 2 * kOverlap || picture.width != picture.height)
    return Error{path + ": the gravel has to be square and wider than 96 pixels"};
  std::vector<float> grey;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) grey.push_back(picture.at(x, y)[1]);
  const int side = picture.width - kOverlap;
  grey = seamless_columns(grey, picture.width, picture.height, kOverlap);
  grey = seamless_columns(turned(grey, side, picture.height), picture.height, side, kOverlap);
  // The photograph is grey; slow drawn noise gives it the browns and greens of a bottom.
  const Raster8 tint = pebbles_tint(side, 11);
  Raster8 out(side, side, 3);
  for (std::size_t i = 0; i < grey.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const float code = grey[i] * static_cast<float>(tint.samples[3 * i + c]) / 128.0f;
      out.samples[3 * i + c] = static_cast<std::uint8_t>(std::clamp(code, 0.0f, 255.0f) + 0.5f);
    }
  }
  return out;
}

Raster8 bottom_picture(const std::string& folder) {
  auto gravel = read_gravel(folder + "/gravel.png");
  return gravel ? std::move(*gravel) : pebbles_picture(1024, 3);
}

TargetPhoto make_photo(Renderer& renderer, const Scene& scene,
                       const Transform<World, LeftCamera>& world_from_left, int texture,
                       const Eigen::Vector2d& size_m, double distance_m, Parallel& parallel) {
  const Intrinsics& left = renderer.rig().left;
  const Intrinsics& right = renderer.rig().right;
  const auto blank = [](const Intrinsics& camera) {
    return hal::Image(camera.width, camera.height, hal::PixelFormat::kYuv444);
  };
  TargetPhoto photo{blank(left), blank(left), {}};
  hal::Image unused = blank(right);
  Scene shown = scene;
  shown.objects.clear();
  renderer.render(shown, world_from_left, 0, 0, parallel, target_of(photo.background),
                  target_of(unused));
  const Transform<LeftCamera, Target> squarely{Eigen::Quaterniond::Identity(), {0, 0, distance_m}};
  shown.objects.push_back({texture, world_from_left * squarely, size_m, 0});
  renderer.render(shown, world_from_left, 0, 1, parallel, target_of(photo.target),
                  target_of(unused));
  photo.mask = Raster8(left.width, left.height, 1);
  photo.mask.samples = renderer.cover(shown, world_from_left);
  return photo;
}

}  // namespace gannet::world
