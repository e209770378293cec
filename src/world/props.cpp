#include "src/world/props.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "src/modeldb/model_file.hpp"
#include "src/vision/patch_model.hpp"
#include "src/world/assets.hpp"
#include "src/world/texture_made.hpp"

namespace gannet::world {
namespace {

constexpr double kPhotoDistance_m = 0.4;
constexpr double kFills = 0.85;  // of the image, at most
constexpr double kBehind_m = 0.6;

// Drawn pictures differ by name, so that two targets do not look the same.
image_file::Raster8 drawn(const std::string& name) {
  std::uint64_t seed = 1;
  for (const char c : name) seed = seed * 31 + static_cast<unsigned char>(c);
  return noise_picture(256, seed);
}

// A flat thing's other side.
image_file::Raster8 mirrored(const image_file::Raster8& picture) {
  image_file::Raster8 out(picture.width, picture.height, picture.channels);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      std::copy_n(picture.at(picture.width - 1 - x, y), picture.channels, out.at(x, y));
  return out;
}

Result<image_file::Raster8> picture_of(const TargetScenario& target, const std::string& assets,
                                       std::vector<std::string>& notes) {
  const std::string other_side = " mirrored";
  if (target.texture.ends_with(other_side)) {
    TargetScenario plain = target;
    plain.texture.resize(target.texture.size() - other_side.size());
    auto picture = picture_of(plain, assets, notes);
    if (!picture) return picture.error();
    notes.back() += ", mirrored";
    return mirrored(*picture);
  }
  if (target.texture == "drawn") {
    notes.push_back(target.name + ": a drawn picture");
    return drawn(target.name);
  }
  if (target.texture == "person") {
    notes.push_back(target.name + ": a drawn person");
    return person_picture(1);
  }
  const Creature* creature = find_creature(target.texture);
  if (creature == nullptr) {
    std::string names = "drawn, person";
    for (const Creature& known : creatures()) names += ", " + std::string(known.name);
    return Error{"target '" + target.name + "': there is no texture '" + target.texture +
                 "'; there are, each also with ' mirrored': " + names};
  }
  auto picture = read_stamp(assets + "/" + std::string(creature->picture));
  if (!picture) {
    notes.push_back(target.name + ": a drawn picture, for the photograph is absent (make assets)");
    return drawn(target.name);
  }
  notes.push_back(target.name + ": photograph of a " + std::string(creature->shows) +
                  (creature->stand_in ? ", a stand-in" : ""));
  return picture;
}

double photo_distance(const Intrinsics& camera, const Eigen::Vector2d& size_m) {
  const Eigen::Vector2d f = camera.magnification();
  const double by_width = size_m.x() * f.x() / (kFills * camera.width);
  const double by_height = size_m.y() * f.y() / (kFills * camera.height);
  return std::max({kPhotoDistance_m, by_width, by_height});
}

// The surroundings of the photo: the usual ground behind the target, in air.
Scene studio(const StageTextures& places, const Transform<World, LeftCamera>& eye,
             double distance_m) {
  Scene scene;
  SceneObject ground;
  ground.texture = places.background;
  ground.pose = eye * Transform<LeftCamera, Target>{Eigen::Quaterniond::Identity(),
                                                    {0, 0, distance_m + kBehind_m}};
  ground.size_m = {30, 30};
  ground.tile_m = kBottomTile_m;
  scene.background.push_back(ground);
  return scene;
}

Result<void> make_model(const TargetScenario& target, int texture, const StageTextures& places,
                        Renderer& renderer, Parallel& parallel, const std::string& path) {
  const Intrinsics& camera = renderer.rig().left;
  const Eigen::Vector2d size_m(target.size_mm[0] / 1000, target.size_mm[1] / 1000);
  const double distance_m = photo_distance(camera, size_m);
  const auto eye = Transform<World, LeftCamera>::identity();
  const TargetPhoto photo = make_photo(renderer, studio(places, eye, distance_m), eye, texture,
                                       size_m, distance_m, parallel);
  hal::Image mask(camera.width, camera.height, hal::PixelFormat::kYuv444);
  std::memcpy(mask.plane(0), photo.mask.samples.data(), photo.mask.samples.size());
  const hal::ImageView background = photo.background.view();
  const hal::ImageView mask_view = mask.view();
  vision::PhotoInput input;
  input.target = photo.target.view();
  input.background = &background;
  input.mask = &mask_view;
  input.distance_m = distance_m;
  input.name = target.name;
  // Where the stage has it: thin parts at its edge are less than half opaque and not in the mask.
  input.origin_px = camera.project({0, 0, distance_m});
  const auto patch = vision::cut_out(input, camera);
  if (!patch) return Error{"model of '" + target.name + "': " + patch.error().text};
  return modeldb::save_model(path, *patch);
}

}  // namespace

Result<Pictures> gather_pictures(const Scenario& scenario, const std::string& assets) {
  Pictures pictures;
  pictures.textures.emplace_back(bottom_picture(assets), Texture::Edge::kTile);
  pictures.textures.emplace_back(noise_picture(128, 99), Texture::Edge::kClamp);
  pictures.places.background = 0;
  pictures.places.cover = 1;
  for (const TargetScenario& target : scenario.targets) {
    auto picture = picture_of(target, assets, pictures.notes);
    if (!picture) return picture.error();
    pictures.places.targets.push_back(static_cast<int>(pictures.textures.size()));
    pictures.textures.emplace_back(*picture, Texture::Edge::kClamp);
  }
  return pictures;
}

Result<std::vector<std::string>> make_models(const Scenario& scenario, const StageTextures& places,
                                             Renderer& renderer, Parallel& parallel,
                                             const std::string& folder) {
  std::vector<std::string> paths;
  for (std::size_t i = 0; i < scenario.targets.size(); ++i) {
    const TargetScenario& target = scenario.targets[i];
    if (!target.known) continue;
    const std::string path = folder + "/" + target.name + ".gannet";
    const auto made = make_model(target, places.targets[i], places, renderer, parallel, path);
    if (!made) return made.error();
    paths.push_back(path);
  }
  return paths;
}

}  // namespace gannet::world
