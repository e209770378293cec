#include "tests/bench/peers/views.hpp"

#include <cmath>

#include "src/world/texture_made.hpp"

namespace gannet::bench {
namespace {

constexpr double kDegree = 3.14159265358979 / 180;
enum Picture { kWall, kTarget, kTag, kBoard };

StereoRig rig_640() {
  StereoRig rig;
  for (Intrinsics* c : {&rig.left, &rig.right}) {
    c->width = 640, c->height = 480, c->fx = c->fy = 640, c->cx = 319.5, c->cy = 239.5;
  }
  rig.right_from_left.translation = {-0.12, 0, 0};
  return rig;
}

std::vector<world::Texture> textures(const image_file::Raster8& tag) {
  using world::Texture;
  std::vector<Texture> out;
  out.emplace_back(world::pebbles_picture(512, 3), Texture::Edge::kTile);
  out.emplace_back(world::noise_picture(256, 4), Texture::Edge::kClamp);
  out.emplace_back(tag, Texture::Edge::kClamp);
  out.emplace_back(world::pebbles_picture(256, 9), Texture::Edge::kClamp);
  return out;
}

world::Scene empty_scene(double lux) {
  world::Scene scene;
  world::SceneObject wall;
  wall.texture = kWall, wall.tile_m = 0.6, wall.size_m = {50, 50};
  wall.pose.translation = {0, 0, 1.3};
  scene.background.push_back(wall);
  scene.light.lux = lux;
  return scene;
}

bool sees(const Intrinsics& camera, const Eigen::Vector3d& point) {
  const auto pixel = camera.project(point);
  return pixel && pixel->x() >= 2 && pixel->y() >= 2 && pixel->x() < camera.width - 2 &&
         pixel->y() < camera.height - 2;
}

}  // namespace

Pose random_pose(const StereoRig& rig, Random& random) {
  const auto between = [&](double low, double high) {
    return low + (high - low) * random.uniform();
  };
  for (;;) {
    Pose pose;
    pose.translation = {between(-0.25, 0.35), between(-0.25, 0.25), between(0.4, 0.9)};
    const double rx = between(-35, 35), ry = between(-35, 35), rz = between(-40, 40);
    pose.rotation = quaternion_from_rpy(rx * kDegree, ry * kDegree, rz * kDegree);
    bool seen = true;
    for (const double x : {-kSide_m / 2, kSide_m / 2}) {
      for (const double y : {-kSide_m / 2, kSide_m / 2}) {
        const Eigen::Vector3d corner = pose({x, y, 0});
        seen = seen && sees(rig.left, corner) && sees(rig.right, rig.right_from_left(corner));
      }
    }
    if (seen) return pose;
  }
}

Pose pose_in_film(const Pose& middle, int i) {
  Pose pose = middle;
  pose.translation += Eigen::Vector3d(0.04 * std::sin(0.13 * i), 0.03 * std::sin(0.19 * i),
                                      0.03 * std::sin(0.1 * i));
  const Eigen::Vector3d turn(0.12 * std::sin(0.11 * i), 0.12 * std::sin(0.15 * i),
                             0.15 * std::sin(0.08 * i));
  pose.rotation = middle.rotation * quaternion_from_rotation_vector(turn);
  return pose;
}

Views::Views(const image_file::Raster8& tag) : renderer_(rig_640(), textures(tag), {}, 1) {}

world::TargetPhoto Views::photo() {
  Serial serial;
  return world::make_photo(renderer_, empty_scene(400), {}, kTarget, {kSide_m, kSide_m},
                           kPhotoRange_m, serial);
}

View Views::see(const Condition& condition, bool tag, const Pose& pose, std::uint64_t number) {
  world::Scene scene = empty_scene(condition.lux);
  if (condition.turbid) scene.water = world::turbid_water();
  world::SceneObject target;
  target.texture = tag ? kTag : kTarget;
  target.size_m = {kSide_m, kSide_m};
  target.pose.rotation = pose.rotation, target.pose.translation = pose.translation;
  scene.objects.push_back(target);
  if (condition.hidden > 0) {  // a board 5 mm before it, a little larger at its free sides
    const double width = condition.hidden * kSide_m + 0.02;
    const double x = kSide_m / 2 + 0.02 - width / 2;
    world::SceneObject board = target;
    board.texture = kBoard;
    board.size_m = {width, kSide_m + 0.04};
    // On the nearer side: the world draws by the distance of the middles.
    const Eigen::Vector3d one = target.pose({x, 0, -0.005}), other = target.pose({-x, 0, -0.005});
    board.pose.translation = one.norm() < other.norm() ? one : other;
    scene.objects.push_back(board);
  }
  View view{hal::Image(640, 480, hal::PixelFormat::kYuyv), {}, pose};
  view.right = view.left;
  Serial serial;
  renderer_.render(scene, {}, static_cast<double>(number) / 30.0, number, serial,
                   world::target_of(view.left), world::target_of(view.right));
  return view;
}

}  // namespace gannet::bench
