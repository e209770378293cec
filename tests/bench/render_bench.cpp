// Milliseconds of one core for a stereo pair at 640×480: three scenes, from the everyday one to the
// heaviest. Thread CPU time, so that other work on the machine does not count.
#include "src/world/renderer.hpp"
#include "src/world/texture_made.hpp"
#include "tests/bench/benches.hpp"

namespace gannet::bench {
namespace {

using namespace gannet::world;

StereoRig rig_640() {
  StereoRig rig;
  for (Intrinsics* c : {&rig.left, &rig.right}) {
    c->width = 640, c->height = 480, c->fx = c->fy = 640, c->cx = 319.5, c->cy = 239.5;
  }
  rig.right_from_left.translation = {-0.12, 0, 0};
  return rig;
}

Scene scene_before(double slant_rad) {
  Scene scene;
  SceneObject bottom, target;
  bottom.tile_m = 0.6, bottom.size_m = {50, 50};
  bottom.pose.translation = {0, 0, 1.0};
  bottom.pose.rotation = quaternion_from_rpy(-slant_rad, 0, 0);
  scene.background.push_back(bottom);
  target.texture = 1, target.size_m = {0.185, 0.13};
  target.pose.translation = {0, 0, 0.5};
  scene.objects.push_back(target);
  scene.water = turbid_water();
  scene.light.lux = 20;
  return scene;
}

void measure(const char* what, Renderer& renderer, const Scene& scene, int frames,
             Results& results) {
  hal::Image left(640, 480, hal::PixelFormat::kYuyv), right = left;
  Serial serial;
  std::vector<double> ms;
  for (int i = 0; i < frames; ++i) {
    const double start = thread_cpu_ns();
    renderer.render(scene, {}, i / 30.0, static_cast<std::uint64_t>(i), serial, target_of(left),
                    target_of(right));
    ms.push_back((thread_cpu_ns() - start) / 1e6);
  }
  results.add({what, "ms per pair", spread_of(ms), frames, {}, ""});
}

}  // namespace

void bench_render(const Options& options, Results& results) {
  results.group("the simulated world's renderer",
                "A stereo pair of 640 x 480 on one core; a frame at 30 Hz has 33 ms.");
  const int frames = options.quick ? 1 : 15;
  std::vector<Texture> textures;
  textures.emplace_back(pebbles_picture(options.quick ? 64 : 512, 3), Texture::Edge::kTile);
  textures.emplace_back(noise_picture(options.quick ? 64 : 256, 4), Texture::Edge::kClamp);
  Renderer renderer(rig_640(), std::move(textures), {}, 1);
  measure("target before a wall", renderer, scene_before(0), frames, results);
  measure("target over a slanted bottom", renderer, scene_before(1.1), frames, results);
  Scene heavy = scene_before(1.1);
  heavy.light.ambient = 0.5, heavy.light.caustics = 0.7;
  heavy.particles.count = 400;
  measure("the same, caustics, 400 particles", renderer, heavy, frames, results);
}

}  // namespace gannet::bench
