// Renderer: what both cameras of a rig see of a scene, into the caller's memory. The picture
// follows from scene, pose, time, seed and frame number alone, bit for bit, on one thread or many.
//
//   1 every surface, far to near: ray, texture over the pixel's footprint, light, water, over
//   2 marine snow    3 Gaussian blur (defocus, motion)    4 electrons, noise, code, YUV
//
// Light is linear until 4. The cameras are those of the rig, lens distortion included. Not a real-
// time path: it takes memory at creation and a little when the scene grows. One caller at a time;
// the work itself is shared by `parallel`.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "platform/base/parallel.hpp"
#include "src/core/stereo_rig.hpp"
#include "src/world/renderer_output.hpp"
#include "src/world/renderer_surface.hpp"
#include "src/world/scene.hpp"
#include "src/world/sensor.hpp"
#include "src/world/texture.hpp"

namespace gannet::world {

struct RendererConfig {
  SensorConfig sensor;
  double blur_x_px = 0.5;  // standard deviation; about what a good lens and a pixel's filter do
  double blur_y_px = 0.5;
};
void describe(Visitor& v, RendererConfig& c);

enum class Eye { kLeft, kRight };

class Renderer {
 public:
  // Scenes name textures by their place in the list. A rig that passed check(); even sides.
  Renderer(const StereoRig& rig, std::vector<Texture> textures, const RendererConfig& config,
           std::uint64_t seed);

  const StereoRig& rig() const { return rig_; }
  const std::vector<Texture>& textures() const { return textures_; }

  // Both pictures of one moment. Targets have the cameras' sizes.
  void render(const Scene& scene, const Transform<World, LeftCamera>& world_from_left,
              double time_s, std::uint64_t frame_number, Parallel& parallel,
              const ImageTarget& left, const ImageTarget& right);

  // Whether the scene's objects (not its background) cover more than half of each pixel in the left
  // image: 255 or 0, tight rows. For masks of photos.
  std::vector<std::uint8_t> cover(const Scene& scene,
                                  const Transform<World, LeftCamera>& world_from_left);

  // Light that reached the sensor in the last picture, before blur in y and before step 4: R, G, B
  // and the share covered by surfaces. Row-major, the camera's width a row.
  const Float4* light(Eye eye) const { return eyes_[static_cast<std::size_t>(eye)].light.data(); }

 private:
  struct View {
    Intrinsics camera;
    SightTable sights;
    std::vector<Float4> light;
    std::vector<Surface> surfaces;
    Transform<World, LeftCamera> world_from_camera;  // of whichever eye
    ImageTarget target;
  };
  void place(const Scene& scene, double time_s, View& view);

  void draw_rows(View& view, int first, int end) const;
  bool is_open_water(const View& view, int y) const;
  void develop_rows(const View& view, std::uint64_t key, int first, int end, Float4* scratch) const;

  StereoRig rig_;
  std::vector<Texture> textures_;
  RendererConfig config_;
  std::uint64_t seed_;
  Texture caustics_;
  std::vector<float> blur_x_, blur_y_;  // one-sided weights, the middle first
  Sensor sensor_;
  Water water_of_table_;
  WaterTable water_;
  bool rows_repeat_ = false;  // nothing is added to what surfaces show: no noise, blur or snow
  std::vector<View> eyes_;
  std::vector<std::vector<Float4>> scratch_;  // one a worker
};

}  // namespace gannet::world
