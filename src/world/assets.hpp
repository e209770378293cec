// The pictures that the simulated world is papered with: photographs fetched by `make assets` from
// Debian's packages (docs/design/assets.md), and pictures drawn by rule where those are absent.
// Start-up only.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>

#include "hal/camera/image.hpp"
#include "platform/base/parallel.hpp"
#include "platform/base/result.hpp"
#include "src/image_file/raster.hpp"
#include "src/world/renderer.hpp"
#include "src/world/texture.hpp"

namespace gannet::world {

// A creature of the papers and the photograph that shows it or stands in for it.
struct Creature {
  std::string_view name;     // as in the papers
  std::string_view picture;  // file in the folder of assets
  std::string_view shows;    // what is on the photograph
  bool stand_in;             // it shows something else than the name says
  double width_m, height_m;  // of the papers' target; the photograph is stretched to it
};
std::span<const Creature> creatures();
const Creature* find_creature(std::string_view name);  // null: unknown

// Where the photographs are: $GANNET_ASSETS, ../share/gannet/assets beside an installed program, or
// where `make assets` puts them, build/assets below the working directory.
std::string assets_folder();
bool assets_present(const std::string& folder);

// A photograph with alpha, cut to the box around what is more than half opaque, so that the
// rectangle's size and middle are those of its silhouette (the target frame's origin).
Result<image_file::Raster8> read_stamp(const std::string& path);
image_file::Raster8 cut_to_silhouette(const image_file::Raster8& picture);

// The bottom: a photograph of gravel made seamless and tinted, at 1024 × 1024; a tile of it is
// 0.6 m wide. Without the file: pebbles drawn by rule.
Result<image_file::Raster8> read_gravel(const std::string& path);
image_file::Raster8 bottom_picture(const std::string& folder);
inline constexpr double kBottomTile_m = 0.6;

// What a user photographs to make a model: the target squarely before the left camera, the same
// view without it, and the mask of its silhouette (grey, 255 = target). Colours are developed as
// the camera does it, full-range BT.601 at 4:4:4.
struct TargetPhoto {
  hal::Image target;
  hal::Image background;
  image_file::Raster8 mask;
};

// scene lends water, light and background; its objects are not in the picture. texture and size_m
// are the target's. The scene's background has to lie behind distance_m.
TargetPhoto make_photo(Renderer& renderer, const Scene& scene,
                       const Transform<World, LeftCamera>& world_from_left, int texture,
                       const Eigen::Vector2d& size_m, double distance_m, Parallel& parallel);

}  // namespace gannet::world
