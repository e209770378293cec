#include "src/world/renderer.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "src/search/exact_math.hpp"
#include "src/world/renderer_snow.hpp"
#include "src/world/texture_made.hpp"

namespace gannet::world {
namespace {

constexpr int kRowsAPiece = 16;  // even: pairs of rows share chroma

// Weights 0 … ⌈3σ⌉ of a normalised Gaussian.
std::vector<float> gaussian(double sigma_px) {
  std::vector<double> w{1};
  const int radius = static_cast<int>(std::ceil(3 * sigma_px));
  double sum = 1;
  for (int i = 1; i <= radius; ++i) {
    const double x = i / sigma_px;
    w.push_back(search::exact_exp(-0.5 * x * x));
    sum += 2 * w.back();
  }
  std::vector<float> out;
  for (double x : w) out.push_back(static_cast<float>(x / sum));
  return out;
}

std::size_t at(int row, int width) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(width);
}

void blur_row(Float4* row, int width, const std::vector<float>& weights, Float4* scratch) {
  const int radius = static_cast<int>(weights.size()) - 1;
  if (radius == 0) return;
  std::copy(row, row + width, scratch + radius);
  std::fill(scratch, scratch + radius, row[0]);
  std::fill(scratch + radius + width, scratch + 2 * radius + width, row[width - 1]);
  for (int x = 0; x < width; ++x) {
    const Float4* middle = scratch + radius + x;
    Float4 sum = middle[0] * weights[0];
    for (int k = 1; k <= radius; ++k)
      sum += (middle[-k] + middle[k]) * weights[static_cast<std::size_t>(k)];
    row[x] = sum;
  }
}

void blur_column(const Float4* image, int width, int height, int y,
                 const std::vector<float>& weights, Float4* out) {
  const int radius = static_cast<int>(weights.size()) - 1;
  const Float4* middle = image + at(y, width);
  for (int x = 0; x < width; ++x) out[x] = middle[x] * weights[0];
  for (int k = 1; k <= radius; ++k) {
    const Float4* above = image + at(std::max(y - k, 0), width);
    const Float4* below = image + at(std::min(y + k, height - 1), width);
    const float w = weights[static_cast<std::size_t>(k)];
    for (int x = 0; x < width; ++x) out[x] += (above[x] + below[x]) * w;
  }
}

Float4 shade_of(const Light& light, const SceneObject& object) {
  const Eigen::Vector3d to_viewer = -(object.pose.rotation * Eigen::Vector3d::UnitZ());
  const double facing = std::max(0.0, -light.sun.normalized().dot(to_viewer));
  const double amount = light.ambient + (1 - light.ambient) * facing;
  const Eigen::Vector3f rgb = (light.tint * amount).cast<float>();
  return Float4{rgb.x(), rgb.y(), rgb.z(), 1};
}

Caustics caustics_at(const Light& light, const Texture& pattern, double time_s) {
  Caustics c;
  if (light.caustics <= 0 || light.ambient >= 1) return c;
  c.pattern = &pattern;
  c.strength = static_cast<float>(light.caustics * (1 - light.ambient));
  c.per_metre = static_cast<float>(1 / (4 * light.caustics_scale_m));
  const double speed[2][2] = {{0.061, 0.043}, {-0.053, 0.037}};  // tiles a second
  for (int layer = 0; layer < 2; ++layer) {
    for (int axis = 0; axis < 2; ++axis) {
      const double moved = time_s * speed[layer][axis] + 0.37 * layer;
      c.shift[layer][axis] = static_cast<float>(moved - std::floor(moved));
    }
  }
  return c;
}

}  // namespace

void describe(Visitor& v, RendererConfig& c) {
  v.group("sensor", c.sensor, "From light to coded pixels.");
  v.field("blur_x_px", c.blur_x_px,
          {.min = 0, .max = 20, .unit = "px", .help = "Blur across, standard deviation."});
  v.field("blur_y_px", c.blur_y_px,
          {.min = 0, .max = 20, .unit = "px", .help = "Blur down, standard deviation."});
}

Renderer::Renderer(const StereoRig& rig, std::vector<Texture> textures,
                   const RendererConfig& config, std::uint64_t seed)
    : rig_(rig),
      textures_(std::move(textures)),
      config_(config),
      seed_(seed),
      caustics_(caustics_picture(), Texture::Edge::kTile),
      blur_x_(gaussian(config.blur_x_px)),
      blur_y_(gaussian(config.blur_y_px)),
      sensor_(config.sensor),
      water_(Water{}) {
  for (const Intrinsics* camera : {&rig_.left, &rig_.right}) {
    const std::size_t pixels = at(camera->height, camera->width);
    eyes_.push_back({*camera, SightTable(*camera), std::vector<Float4>(pixels), {}, {}, {}});
  }
}

// Puts the scene's things into the eye's frame, far to near.
void Renderer::place(const Scene& scene, double time_s, View& view) {
  const Transform<LeftCamera, World> camera_from_world = view.world_from_camera.inverse();
  const Caustics caustics = caustics_at(scene.light, caustics_, time_s);
  view.surfaces.clear();
  const auto add = [&](const SceneObject& object) {
    const Transform<LeftCamera, Target> pose = camera_from_world * object.pose;
    view.surfaces.emplace_back(object, textures_.at(static_cast<std::size_t>(object.texture)),
                               pose.rotation, pose.translation, view.camera,
                               shade_of(scene.light, object));
    if (caustics.pattern) view.surfaces.back().set_caustics(caustics, object);
  };
  for (const SceneObject& object : scene.background) add(object);
  const auto first = static_cast<std::ptrdiff_t>(view.surfaces.size());
  for (const SceneObject& object : scene.objects) add(object);
  std::stable_sort(
      view.surfaces.begin() + first, view.surfaces.end(),
      [](const Surface& a, const Surface& b) { return a.distance_m() > b.distance_m(); });
}

void Renderer::draw_rows(View& view, int first, int end) const {
  const int width = view.camera.width;
  for (int y = first; y < end; ++y) {
    Float4* row = view.light.data() + at(y, width);
    std::fill(row, row + width, water_.endless());
    for (const Surface& surface : view.surfaces) surface.draw_row(view.sights, y, water_, row);
  }
}

// Rows y and y + 1 show water alone, and all such rows are the same.
bool Renderer::is_open_water(const View& view, int y) const {
  return rows_repeat_ && view.target.plane[1] == nullptr &&
         std::none_of(view.surfaces.begin(), view.surfaces.end(),
                      [&](const Surface& s) { return y + 1 >= s.first_row() && y < s.end_row(); });
}

void Renderer::develop_rows(const View& view, std::uint64_t key, int first, int end,
                            Float4* scratch) const {
  const int width = view.camera.width;
  const auto row_bytes = static_cast<std::size_t>(view.target.stride[0]);
  std::uint8_t* open_water = nullptr;  // rows of it that are done
  for (int y = first; y < end; y += 2) {
    if (is_open_water(view, y)) {
      std::uint8_t* const here = view.target.plane[0] + static_cast<std::size_t>(y) * row_bytes;
      if (open_water != nullptr) {
        std::copy_n(open_water, 2 * row_bytes, here);
        continue;
      }
      open_water = here;
    }
    Float4* rows[2] = {scratch, scratch + width};
    for (int i = 0; i < 2; ++i) {
      blur_column(view.light.data(), width, view.camera.height, y + i, blur_y_, rows[i]);
      sensor_.develop(rows[i], rows[i], width, hashed(key, static_cast<std::uint64_t>(y + i)));
    }
    write_rows(view.target, y, rows[0], rows[1]);
  }
}

std::vector<std::uint8_t> Renderer::cover(const Scene& scene,
                                          const Transform<World, LeftCamera>& world_from_left) {
  View& view = eyes_[0];
  view.world_from_camera = world_from_left;
  Scene objects_only = scene;
  objects_only.background.clear();
  place(objects_only, 0, view);
  draw_rows(view, 0, view.camera.height);
  std::vector<std::uint8_t> mask;
  for (const Float4& pixel : view.light) mask.push_back(pixel[3] > 0.5f ? 255 : 0);
  return mask;
}

void Renderer::render(const Scene& scene, const Transform<World, LeftCamera>& world_from_left,
                      double time_s, std::uint64_t frame_number, Parallel& parallel,
                      const ImageTarget& left, const ImageTarget& right) {
  assert(left.width == rig_.left.width && left.height == rig_.left.height);
  assert(right.width == rig_.right.width && right.height == rig_.right.height);
  const Transform<LeftCamera, RightCamera> left_from_right = rig_.right_from_left.inverse();
  eyes_[0].world_from_camera = world_from_left;
  eyes_[1].world_from_camera.rotation = world_from_left.rotation * left_from_right.rotation;
  eyes_[1].world_from_camera.translation = world_from_left(left_from_right.translation);
  eyes_[0].target = left;
  eyes_[1].target = right;
  if (!(scene.water == water_of_table_)) {
    water_of_table_ = scene.water;
    water_ = WaterTable(scene.water);
  }
  sensor_.set_light(scene.light.lux);
  for (View& view : eyes_) place(scene, time_s, view);
  rows_repeat_ = !config_.sensor.noise && blur_x_.size() == 1 && blur_y_.size() == 1 &&
                 scene.particles.count == 0;

  const int tallest = std::max(rig_.left.height, rig_.right.height);
  const int widest = std::max(rig_.left.width, rig_.right.width);
  const int pieces = (tallest + kRowsAPiece - 1) / kRowsAPiece;
  scratch_.resize(static_cast<std::size_t>(parallel.workers()));
  for (auto& s : scratch_) s.resize(at(2, widest) + 2 * std::max(blur_x_.size(), blur_y_.size()));
  const auto each = [&](auto&& work) {
    parallel.for_each(2 * pieces, [&](int index, int worker) {
      View& view = eyes_[static_cast<std::size_t>(index / pieces)];
      const int first = index % pieces * kRowsAPiece;
      const int end = std::min(first + kRowsAPiece, view.camera.height);
      work(view, index / pieces, first, end, scratch_[static_cast<std::size_t>(worker)].data());
    });
  };
  each([&](View& view, int, int first, int end, Float4*) { draw_rows(view, first, end); });
  for (View& view : eyes_)
    draw_snow(scene, time_s, seed_, view.world_from_camera, view.camera, view.surfaces, water_,
              view.light);
  if (blur_x_.size() > 1) {
    each([&](View& view, int, int first, int end, Float4* scratch) {
      for (int y = first; y < end; ++y)
        blur_row(view.light.data() + at(y, view.camera.width), view.camera.width, blur_x_, scratch);
    });
  }
  each([&](View& view, int eye, int first, int end, Float4* scratch) {
    const std::uint64_t key = hashed(hashed(seed_, frame_number), static_cast<std::uint64_t>(eye));
    develop_rows(view, key, first, end, scratch);
  });
}

}  // namespace gannet::world
