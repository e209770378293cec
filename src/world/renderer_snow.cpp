#include "src/world/renderer_snow.hpp"

#include <algorithm>
#include <cmath>

#include "platform/base/random.hpp"

namespace gannet::world {
namespace {

constexpr double kNearest_m = 0.05;  // nearer ones would be out of focus and fill the picture

bool hidden(const std::vector<Surface>& surfaces, const Eigen::Vector3d& p, const Sight& sight) {
  return std::any_of(surfaces.begin(), surfaces.end(), [&](const Surface& s) {
    const float depth = s.opaque_depth(sight);
    return depth > 0 && static_cast<double>(depth) < p.z();
  });
}

void draw_disc(const Eigen::Vector2d& centre, double radius_px, Float4 seen,
               const Intrinsics& camera, std::vector<Float4>& light) {
  // A sphere smaller than a pixel keeps its light: the disc is a pixel wide, but thinner.
  const double drawn = std::max(radius_px, 0.6);
  const float thin = static_cast<float>(radius_px * radius_px / (drawn * drawn));
  const auto from = [&](double c) { return std::max(0, static_cast<int>(c - drawn - 1)); };
  const auto to = [&](double c, int n) { return std::min(n - 1, static_cast<int>(c + drawn + 2)); };
  for (int y = from(centre.y()); y <= to(centre.y(), camera.height); ++y) {
    for (int x = from(centre.x()); x <= to(centre.x(), camera.width); ++x) {
      const double away = std::hypot(x - centre.x(), y - centre.y());
      const float share = thin * static_cast<float>(std::clamp(drawn + 0.5 - away, 0.0, 1.0));
      Float4& pixel = light[static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width) +
                            static_cast<std::size_t>(x)];
      pixel = seen * share + pixel * (1 - share);
    }
  }
}

}  // namespace

void draw_snow(const Scene& scene, double time_s, std::uint64_t seed,
               const Transform<World, LeftCamera>& world_from_camera, const Intrinsics& camera,
               const std::vector<Surface>& surfaces, const WaterTable& water,
               std::vector<Float4>& light) {
  const Particles& particles = scene.particles;
  Random random(seed ^ 0x5eaf100du);
  const auto camera_from_world = world_from_camera.inverse();
  const double cube = particles.cube_m;
  const Eigen::Vector3d middle =
      world_from_camera.translation + world_from_camera.rotation * Eigen::Vector3d(0, 0, cube / 2);
  const Eigen::Vector3f tint = (scene.light.tint * particles.albedo).cast<float>();
  for (int i = 0; i < particles.count; ++i) {
    const Eigen::Vector3d start(random.uniform() * cube, random.uniform() * cube,
                                random.uniform() * cube);
    const double radius_m = particles.radius_m * (0.5 + random.uniform());
    Eigen::Vector3d place = start + time_s * particles.drift_m_s - middle;
    for (int axis = 0; axis < 3; ++axis) place[axis] -= cube * std::round(place[axis] / cube);
    const Eigen::Vector3d p = camera_from_world(place + middle);
    if (p.z() < kNearest_m) continue;
    const auto pixel = camera.project(p);
    if (!pixel) continue;
    const Sight sight = camera.port ? sight_of(camera, *pixel)
                                    : Sight{static_cast<float>(p.x() / p.z()),
                                            static_cast<float>(p.y() / p.z()), 0};
    if (hidden(surfaces, p, sight)) continue;
    if (pixel->x() < -5 || pixel->y() < -5 || pixel->x() > camera.width + 5 ||
        pixel->y() > camera.height + 5)
      continue;
    const Float4 seen =
        water.seen(Float4{tint.x(), tint.y(), tint.z(), 1}, static_cast<float>(p.norm()));
    draw_disc(*pixel, camera.magnification().x() * radius_m / p.z(), seen, camera, light);
  }
}

}  // namespace gannet::world
