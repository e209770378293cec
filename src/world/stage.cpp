#include "src/world/stage.hpp"

#include <cstddef>

#include "src/world/assets.hpp"

namespace gannet::world {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

Water water_of(const std::string& name) {
  if (name == "pool") return pool_water();
  if (name == "coastal") return coastal_water();
  if (name == "turbid") return turbid_water();
  return {};
}

Transform<Hand, Target> resting(const TargetScenario& target) {
  const std::vector<double>& p = target.position_mm;
  const std::vector<double>& r = target.turn_deg;
  return {quaternion_from_rpy(r[0] * kDegree, r[1] * kDegree, r[2] * kDegree),
          Eigen::Vector3d(p[0], p[1], p[2]) / 1000};
}

}  // namespace

Stage::Stage(const Scenario& scenario, const StageTextures& textures, std::uint64_t seed)
    : has_ground_(scenario.scene.detail == "full"),
      cover_texture_(textures.cover),
      water_(water_of(scenario.scene.water)) {
  const Transform<World, Hand> reference = scenario.world_from_reference();
  for (std::size_t i = 0; i < scenario.targets.size(); ++i) {
    const TargetScenario& target = scenario.targets[i];
    things_.push_back({target.name, reference * resting(target), Motion(target.motion, seed + i),
                       Eigen::Vector2d(target.size_mm[0], target.size_mm[1]) / 1000,
                       textures.targets[i], false});
  }
  const Transform<Hand, Target> wall{Eigen::Quaterniond::Identity(),
                                     {0, 0, scenario.scene.background_mm / 1000}};
  background_.texture = textures.background;
  background_.pose = reference * wall;
  background_.size_m = {30, 30};
  background_.tile_m = kBottomTile_m;
  floor_ = background_;
  // Its far side is down: z of the picture, which looks away from the viewer, becomes the hand's y.
  floor_.pose = reference * Transform<Hand, Target>{quaternion_from_rpy(-90 * kDegree, 0, 0),
                                                    {0, scenario.scene.floor_mm / 1000, 0}};
  has_floor_ = has_ground_ && scenario.scene.floor_mm > 0;
  light_.lux = scenario.scene.light_lux;
  light_.caustics = scenario.scene.caustics;
  if (light_.caustics > 0) light_.ambient = 0.5;  // the rest is sun, which waves can gather
  snow_.count = scenario.scene.snow;
}

int Stage::find(std::string_view name) const {
  for (std::size_t i = 0; i < things_.size(); ++i)
    if (things_[i].name == name) return static_cast<int>(i);
  return -1;
}

Transform<World, Target> Stage::pose(int target, double time_s) const {
  const Thing& thing = things_[at(target)];
  return thing.rest * thing.motion.at(time_s);
}

Scene Stage::scene(double time_s) const {
  Scene scene;
  scene.water = water_;
  scene.light = light_;
  scene.particles = snow_;
  if (has_ground_) scene.background.push_back(background_);
  if (has_floor_) scene.background.push_back(floor_);
  for (std::size_t i = 0; i < things_.size(); ++i) {
    const Thing& thing = things_[i];
    const Transform<World, Target> stands = pose(static_cast<int>(i), time_s);
    scene.objects.push_back({thing.texture, stands, thing.size_m, 0});
    if (!thing.covered) continue;
    const Transform<Target, Target> before{Eigen::Quaterniond::Identity(), {0, 0, -0.05}};
    scene.objects.push_back({cover_texture_, stands * before, 1.4 * thing.size_m, 0});
  }
  return scene;
}

bool Stage::in_view(int target, double time_s, const StereoRig& rig,
                    const Transform<World, Hand>& world_from_hand) const {
  const Transform<LeftCamera, Target> left_from_target =
      rig.hand_from_left.inverse() * world_from_hand.inverse() * pose(target, time_s);
  const Eigen::Vector2d half = 0.5 * size_m(target);
  const auto sees = [](const Intrinsics& camera, const Eigen::Vector3d& point) {
    const auto pixel = camera.project(point);
    return pixel && pixel->x() >= 0 && pixel->y() >= 0 && pixel->x() <= camera.width - 1 &&
           pixel->y() <= camera.height - 1;
  };
  for (const double x : {-half.x(), half.x()}) {
    for (const double y : {-half.y(), half.y()}) {
      const Eigen::Vector3d corner = left_from_target({x, y, 0});
      if (!sees(rig.left, corner) || !sees(rig.right, rig.right_from_left(corner))) return false;
    }
  }
  return true;
}

}  // namespace gannet::world
