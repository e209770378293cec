#include "tests/bench/cluttered_scene.hpp"

namespace gannet::bench {
namespace {

hal::Image yuyv_of(const test::Picture& p) {
  hal::Image out(p.width, p.height, hal::PixelFormat::kYuyv);
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  for (int row = 0; row < p.height; ++row) {
    std::uint8_t* to = out.row(0, row);
    for (int i = 0; i < p.width; i += 2) {
      const std::size_t k = at(row * p.width + i);
      to[2 * i] = p.y[k];
      to[2 * i + 1] = static_cast<std::uint8_t>((p.u[k] + p.u[k + 1] + 1) / 2);
      to[2 * i + 2] = p.y[k + 1];
      to[2 * i + 3] = static_cast<std::uint8_t>((p.v[k] + p.v[k + 1] + 1) / 2);
    }
  }
  return out;
}

// Where a ray of the left camera's frame meets a target's plane, in the target's frame.
Eigen::Vector2d meet(const Pose& pose, const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
  const auto back = pose.inverse();
  const Eigen::Vector3d o = back(origin);
  const Eigen::Vector3d d = back.rotation * ray;
  return (o - d * (o.z() / d.z())).head<2>();
}

}  // namespace

ClutteredScene::ClutteredScene(int width, int height, Bend bend) {
  for (Intrinsics* camera : {&scene_.rig.left, &scene_.rig.right}) {
    camera->width = width;
    camera->height = height;
    camera->fx = camera->fy = width;
    camera->cx = (width - 1) / 2.0;
    camera->cy = (height - 1) / 2.0;
  }
  scene_.ground = test::Texture(12, 0.11, 25);
  scene_.noise = 3;
  bend_light(bend);
}

void ClutteredScene::bend_light(Bend bend) {
  for (Intrinsics* camera : {&scene_.rig.left, &scene_.rig.right}) {
    if (bend == Bend::kLens || bend == Bend::kPortAndLens) {
      camera->distortion = Distortion::kBrown;
      camera->coefficients = {-0.12, 0.03, 0.0005, -0.0003, 0};
    }
    if (bend == Bend::kPort || bend == Bend::kPortAndLens) {
      camera->port = FlatPort{.normal = Eigen::Vector3d(0.02, -0.03, 1).normalized(),
                              .distance_m = 0.06,
                              .thickness_m = 0.015};
      const double by_port = camera->magnification().x() / camera->fx;
      camera->fx /= by_port;
      camera->fy /= by_port;
    }
  }
}

vision::PatchModel ClutteredScene::model(int inside_points) const {
  return scene_.model(inside_points).value();
}

Pose ClutteredScene::random_pose(Random& random) const {
  const auto between = [&](double low, double high) {
    return low + (high - low) * random.uniform();
  };
  for (;;) {
    const Pose pose = test::pose_at(between(-0.25, 0.35), between(-0.25, 0.25), between(0.45, 0.95),
                                    between(-35, 35), between(-35, 35), between(-40, 40));
    bool seen = true;
    for (const double x : {-0.08, 0.08}) {
      for (const double y : {-0.055, 0.055}) {
        const Eigen::Vector3d p = pose({x, y, 0});
        const auto inside = [](const Intrinsics& camera, const Eigen::Vector3d& r) {
          const auto pixel = camera.project(r);
          return pixel && pixel->x() >= 0 && pixel->y() >= 0 && pixel->x() < camera.width &&
                 pixel->y() < camera.height;
        };
        seen = seen && inside(rig().left, p) && inside(rig().right, rig().right_from_left(p));
      }
    }
    if (seen) return pose;
  }
}

Pair ClutteredScene::see(const Pose& pose, std::uint64_t seed) const {
  Random random(seed);
  std::vector<Other> others;
  for (std::uint64_t i = 0; i < 3; ++i) {
    Pose place = random_pose(random);
    // Behind the target, which nothing hides.
    place.translation *=
        (pose.translation.z() + 0.12 + 0.2 * random.uniform()) / place.translation.z();
    others.push_back({test::Texture(1000 + 10 * seed + i, 0.05, 35), place});
  }
  return {eye(true, pose, others, 2 * seed), eye(false, pose, others, 2 * seed + 1), pose};
}

hal::Image ClutteredScene::eye(bool left, const Pose& pose, const std::vector<Other>& others,
                               std::uint64_t seed) const {
  test::Picture picture = scene_.see(left, &pose, seed);
  Random random(seed + 77);
  for (const Other& other : others) paint(left, other, pose, random, picture);
  return yuyv_of(picture);
}

void ClutteredScene::paint(bool left, const Other& other, const Pose& target, Random& random,
                           test::Picture& picture) const {
  for (int row = 0; row < picture.height; ++row) {
    for (int col = 0; col < picture.width; ++col) {
      const auto [origin, ray] = scene_.line_of_sight(left, col, row);
      const Eigen::Vector2d hit = meet(other.pose, origin, ray);
      if (!scene_.covers(hit.x(), hit.y())) continue;
      const Eigen::Vector2d on_target = meet(target, origin, ray);
      if (scene_.covers(on_target.x(), on_target.y())) continue;
      const auto at = static_cast<std::size_t>(row * picture.width + col);
      const auto byte = [&](double colour) {
        colour += scene_.noise * static_cast<double>(random.normal_f());
        return static_cast<std::uint8_t>(std::clamp(std::lround(colour), 0L, 255L));
      };
      picture.y[at] = byte(120 + other.texture.at(0, hit.x(), hit.y()));
      picture.u[at] = byte(110 + 0.6 * other.texture.at(1, hit.x(), hit.y()));
      picture.v[at] = byte(160 + 0.6 * other.texture.at(2, hit.x(), hit.y()));
    }
  }
}

}  // namespace gannet::bench
