#include "tests/report/studio.hpp"

#include <cmath>

#include "src/modeldb/model_file.hpp"
#include "src/world/assets.hpp"

namespace gannet::robustness {
namespace {

constexpr const char* kCreatures[] = {"seahorse", "coelacanth", "dolphin", "lobster", "starfish"};
constexpr double kRadians = 3.14159265358979323846 / 180;
constexpr double kGround_m = 1.6;
const auto kWorldFromLeft = Transform<World, LeftCamera>::identity();

double between(Random& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

// Turbid water of the world's catalogue, thinned until green light is attenuated by c.
world::Water water_of(double c_per_m) {
  world::Water water = world::turbid_water();
  const double share = c_per_m / water.attenuation_per_m[1];
  for (double& b : water.attenuation_per_m) b *= share;
  for (double& b : water.backscatter_per_m) b *= share;
  return water;
}

bool sees_all(const StereoRig& rig, const Pose& pose, const Eigen::Vector2d& size_m) {
  const auto inside = [](const Intrinsics& camera, const Eigen::Vector3d& at) {
    const auto pixel = camera.project(at);
    return pixel && pixel->minCoeff() >= 0 && pixel->x() <= camera.width - 1 &&
           pixel->y() <= camera.height - 1;
  };
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      const Eigen::Vector3d at = pose({x * size_m.x(), y * size_m.y(), 0});
      if (!inside(rig.left, at) || !inside(rig.right, rig.right_from_left(at))) return false;
    }
  }
  return true;
}

world::Scenario scenario_of_creatures() {
  world::Scenario scenario;
  scenario.targets.clear();
  for (const char* name : kCreatures) {
    const world::Creature& look = *world::find_creature(name);
    world::TargetScenario target;
    target.name = target.texture = name;
    target.size_mm = {1000 * look.width_m, 1000 * look.height_m};
    scenario.targets.push_back(target);
  }
  return scenario;
}

}  // namespace

bool sees_all(const Cast& cast, const Staged& staged) {
  return sees_all(cast.rig, staged.truth, cast.size_m[static_cast<std::size_t>(staged.creature)]);
}

Result<Cast> make_cast(const std::string& assets, const std::string& folder) {
  const world::Scenario scenario = scenario_of_creatures();
  auto pictures = world::gather_pictures(scenario, assets);
  if (!pictures) return pictures.error();
  Cast cast;
  cast.rig = scenario.rig();
  cast.textures = std::move(pictures->textures);
  cast.places = pictures->places;
  cast.notes = pictures->notes;
  world::Renderer renderer(cast.rig, cast.textures, {}, 1);
  Serial serial;
  const auto files = world::make_models(scenario, cast.places, renderer, serial, folder);
  if (!files) return files.error();
  for (const std::string& file : *files) {
    const auto photo = modeldb::load_model(file);
    if (!photo) return photo.error();
    auto model = vision::make_patch_model(*photo, {});
    if (!model) return Error{file + ": " + model.error().text};
    cast.models.push_back(std::move(*model));
  }
  for (const auto& target : scenario.targets) {
    cast.size_m.emplace_back(target.size_mm[0] / 1000, target.size_mm[1] / 1000);
  }
  return cast;
}

Pose Studio::pose_in_view(Random& random, const Conditions& conditions, int creature) const {
  const double z = conditions.distance_m, tilt = conditions.tilt_deg * kRadians;
  const auto& size_m = cast_.size_m[static_cast<std::size_t>(creature)];
  for (;;) {
    const double roll = between(random, -35, 35) * kRadians;
    const double towards = between(random, 0, 360) * kRadians;
    const double x = between(random, -0.45, 0.55) * z, y = between(random, -0.35, 0.35) * z;
    const Pose pose = {
        quaternion_from_rpy(tilt * std::cos(towards), tilt * std::sin(towards), roll), {x, y, z}};
    if (sees_all(cast_.rig, pose, size_m)) return pose;
  }
}

world::SceneObject Studio::object(int creature, const Pose& pose) const {
  const auto i = static_cast<std::size_t>(creature);
  return {cast_.places.targets[i], kWorldFromLeft * pose, cast_.size_m[i], 0};
}

void Studio::add_distractors(Random& random, const Conditions& conditions, Staged& staged) const {
  const int others = static_cast<int>(cast_.models.size()) - 1;
  for (int i = 0; i < static_cast<int>(conditions.distractors); ++i) {
    const int creature = (staged.creature + 1 + i % others) % (others + 1);
    const double z = conditions.distance_m + between(random, 0.2, 0.5);  // it hides nothing
    const double rx = between(random, -30, 30) * kRadians, ry = between(random, -30, 30) * kRadians;
    const double rz = between(random, -35, 35) * kRadians;
    const double x = between(random, -0.45, 0.55) * z, y = between(random, -0.35, 0.35) * z;
    staged.scene.objects.push_back(object(creature, {quaternion_from_rpy(rx, ry, rz), {x, y, z}}));
  }
}

// A textured strip along one side of the target's box, 20 mm before its plane.
void Studio::add_cover(Random& random, double share, Staged& staged) const {
  const int side = random.below(4);
  if (share <= 0) return;
  const Eigen::Vector2d& size_m = cast_.size_m[static_cast<std::size_t>(staged.creature)];
  const int axis = side % 2;
  constexpr double kBefore_m = 0.02, kBeyond_m = 0.04;  // how far it reaches out
  Eigen::Vector2d strip_m = size_m.array() + 2 * kBeyond_m;
  strip_m[axis] = share * size_m[axis] + kBeyond_m;
  Eigen::Vector3d middle(0, 0, -kBefore_m);
  middle[axis] = (side < 2 ? -1 : 1) * ((0.5 - share) * size_m[axis] + strip_m[axis] / 2);
  const Transform<Target, Target> aside = {Eigen::Quaterniond::Identity(), middle};
  staged.scene.objects.push_back(
      {cast_.places.cover, kWorldFromLeft * staged.truth * aside, strip_m, 0});
}

Staged Studio::stage(const Conditions& conditions, int trial, int number, Show show) const {
  Random random(world::hashed(seed_, static_cast<std::uint64_t>(number)));
  Staged out;
  out.creature = trial % static_cast<int>(cast_.models.size());
  out.truth = pose_in_view(random, conditions, out.creature);
  out.scene.water = water_of(conditions.turbidity_per_m);
  out.scene.light.lux = conditions.light_lux;
  const Pose ground = {Eigen::Quaterniond::Identity(), {0, 0, kGround_m}};
  out.scene.background.push_back(
      {cast_.places.background, kWorldFromLeft * ground, {30, 30}, world::kBottomTile_m});
  if (show == Show::kTarget) {
    out.scene.objects.push_back(object(out.creature, out.truth));
    add_cover(random, conditions.occlusion, out);
  }
  add_distractors(random, conditions, out);
  return out;
}

Shot Studio::shoot(const Staged& staged, double blur_px, int number) {
  if (!renderer_ || blur_px_ != blur_px) {
    blur_px_ = blur_px;
    renderer_ = std::make_unique<world::Renderer>(
        cast_.rig, cast_.textures,
        world::RendererConfig{.sensor = {}, .blur_x_px = blur_px, .blur_y_px = blur_px}, seed_);
  }
  const Intrinsics& camera = cast_.rig.left;
  Shot shot = {staged.creature, staged.truth,
               hal::Image(camera.width, camera.height, hal::PixelFormat::kYuyv),
               hal::Image(camera.width, camera.height, hal::PixelFormat::kYuyv)};
  Serial serial;
  renderer_->render(staged.scene, kWorldFromLeft, 0, static_cast<std::uint64_t>(number), serial,
                    world::target_of(shot.left), world::target_of(shot.right));
  return shot;
}

Shot Studio::take(const Conditions& conditions, int trial, int number) {
  return shoot(stage(conditions, trial, number, Show::kTarget), conditions.blur_px, number);
}

}  // namespace gannet::robustness
