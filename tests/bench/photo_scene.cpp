#include "tests/bench/photo_scene.hpp"

#include <cstring>

#include "src/world/assets.hpp"
#include "src/world/texture_made.hpp"

namespace gannet::bench {
namespace {

using namespace world;

// Each picture once: crab_p001 is the crab's; the person is larger than what is looked for here.
constexpr const char* kSought[] = {"crab",    "starfish",  "seahorse", "coelacanth",
                                   "dolphin", "jellyfish", "squid",    "lobster"};
constexpr int kDrawn = 4;  // pictures by rule: things that lie about

StereoRig rig_of(int width, int height) {
  StereoRig rig;
  for (Intrinsics* c : {&rig.left, &rig.right}) {
    c->width = width, c->height = height, c->fx = c->fy = width;
    c->cx = (width - 1) / 2.0, c->cy = (height - 1) / 2.0;
  }
  rig.right_from_left.translation = {-0.12, 0, 0};
  rig.hand_from_left.translation = {-0.06, 0, 0};
  return rig;
}

double between(Random& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

// Left camera and world are one here.
Transform<World, Target> in_world(const Pose& pose) { return {pose.rotation, pose.translation}; }

vision::PatchModel model_of(const TargetPhoto& photo, const Intrinsics& camera, const char* name) {
  hal::Image mask(camera.width, camera.height, hal::PixelFormat::kYuv444);
  std::memcpy(mask.plane(0), photo.mask.samples.data(), photo.mask.samples.size());
  const hal::ImageView background = photo.background.view(), mask_view = mask.view();
  vision::PhotoInput input;
  input.target = photo.target.view();
  input.background = &background;
  input.mask = &mask_view;
  input.distance_m = 0.4;
  input.name = name;
  input.origin_px = Eigen::Vector2d(camera.cx, camera.cy);
  return vision::make_patch_model(vision::cut_out(input, camera).value(), {}).value();
}

}  // namespace

PhotoScene::PhotoScene(int width, int height) {
  const std::string folder = assets_folder();
  std::vector<Texture> textures;
  textures.emplace_back(bottom_picture(folder), Texture::Edge::kTile);
  textures.emplace_back(pebbles_picture(512, 3), Texture::Edge::kTile);
  textures.emplace_back(noise_picture(256, 4), Texture::Edge::kTile);
  std::uint64_t seed = 10;
  for (const char* name : kSought) {
    const Creature& creature = *find_creature(name);
    auto picture = read_stamp(folder + "/" + std::string(creature.picture));
    has_photographs_ = has_photographs_ && picture;
    textures.emplace_back(picture ? *picture : noise_picture(128, seed++), Texture::Edge::kClamp);
    sizes_.emplace_back(creature.width_m, creature.height_m);
  }
  for (int i = 0; i < kDrawn; ++i) {
    textures.emplace_back(noise_picture(128, seed++), Texture::Edge::kClamp);
    sizes_.emplace_back(0.1 + 0.02 * i, 0.14);
  }
  renderer_ =
      std::make_unique<Renderer>(rig_of(width, height), std::move(textures), RendererConfig{}, 1);
  Scene studio;
  studio.background = {ground(0, 1, 0)};
  Serial serial;
  for (int i = 0; i < static_cast<int>(std::size(kSought)); ++i) {
    const TargetPhoto photo =
        make_photo(*renderer_, studio, {}, kGrounds + i, sizes_[at(i)], 0.4, serial);
    models_.push_back(model_of(photo, rig().left, kSought[i]));
  }
}

SceneObject PhotoScene::ground(int kind, double depth_m, double tilt_deg) const {
  SceneObject out;
  out.texture = kind;
  out.tile_m = kBottomTile_m;
  out.size_m = {50, 50};
  out.pose = in_world(test::pose_at(0, 0, depth_m, -tilt_deg, 0, 0));
  return out;
}

SceneObject PhotoScene::object(int target, const Pose& pose) const {
  SceneObject out;
  out.texture = kGrounds + target;
  out.size_m = sizes_[at(target)];
  out.pose = in_world(pose);
  return out;
}

bool PhotoScene::in_view(int target, const Pose& pose) const {
  const Eigen::Vector2d half = sizes_[at(target)] / 2;
  for (const int x : {-1, 1}) {
    for (const int y : {-1, 1}) {
      const Eigen::Vector3d p = pose({x * half.x(), y * half.y(), 0});
      for (const auto& pixel :
           {rig().left.project(p), rig().right.project(rig().right_from_left(p))}) {
        if (!pixel || pixel->minCoeff() < 0 || pixel->x() >= rig().left.width ||
            pixel->y() >= rig().left.height) {
          return false;
        }
      }
    }
  }
  return true;
}

Pose PhotoScene::random_pose(Random& random, double nearest_m, double farthest_m) const {
  const double z = between(random, nearest_m, farthest_m);
  return test::pose_at(z * between(random, -0.5, 0.5) + 0.06, z * between(random, -0.36, 0.36), z,
                       between(random, -35, 35), between(random, -35, 35),
                       between(random, -40, 40));
}

PhotoScene::Seen PhotoScene::see(std::uint64_t number, int target) {
  Random random(7000 + number);
  Scene scene;
  const auto pick = [&](int n) { return static_cast<int>(random.uniform() * n); };
  scene.background = {ground(pick(kGrounds), between(random, 1.1, 1.7), between(random, -30, 30))};
  scene.background[0].tile_m *= between(random, 0.5, 2);
  scene.background[0].pose.translation.x() = between(random, -1, 1);
  const Water waters[] = {{}, pool_water(), coastal_water(), turbid_water()};
  const int water = pick(4);
  scene.water = waters[water];
  scene.light.lux = std::pow(10.0, between(random, 0.7, 2.6));
  Seen out{{}, std::vector<bool>(models_.size(), false), water < 2 && scene.light.lux >= 50};
  Pose pose;
  do pose = random_pose(random, 0.45, 0.9);
  while (!in_view(target, pose));
  scene.objects.push_back(object(target, pose));
  out.present[at(target)] = true;
  const double behind = pose.translation.z() + 0.12;
  for (int i = 0, n = 3 + pick(4); i < n; ++i) {
    const int what = pick(static_cast<int>(sizes_.size()));
    if (what == target) continue;
    scene.objects.push_back(
        object(what, random_pose(random, behind, std::max(behind + 0.05, 1.05))));
    if (what < targets()) out.present[at(what)] = true;
  }
  out.pair = render(scene, pose, number);
  return out;
}

Pair PhotoScene::render(const Scene& scene, const Pose& truth, std::uint64_t frame) {
  const auto image = [this] {
    return hal::Image(rig().left.width, rig().left.height, hal::PixelFormat::kYuyv,
                      hal::ColourMatrix::kBt601, hal::ColourRange::kLimited);
  };
  Pair out{image(), image(), truth};
  Serial serial;
  renderer_->render(scene, {}, 0, frame, serial, target_of(out.left), target_of(out.right));
  return out;
}

}  // namespace gannet::bench
