#include "src/world/renderer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <thread>
#include <vector>

#include "hal/camera/pixel_access.hpp"
#include "platform/base/random.hpp"
#include "src/world/assets.hpp"
#include "src/world/texture_made.hpp"

namespace gannet::world {
namespace {

using image_file::Raster8;

StereoRig small_rig() {
  StereoRig rig;
  for (Intrinsics* c : {&rig.left, &rig.right}) {
    c->width = 320, c->height = 240;
    c->fx = c->fy = 320;
    c->cx = 159.5, c->cy = 119.5;
  }
  rig.right_from_left.translation = {-0.12, 0, 0};
  return rig;
}

RendererConfig clean() {
  RendererConfig config;
  config.sensor.noise = false;
  config.blur_x_px = config.blur_y_px = 0;
  return config;
}

// A white round blot with a soft rim and a middle off the picture's middle: its centroid is known.
constexpr double kBlotX = 0.12, kBlotY = -0.08;  // of its middle, in sides from the picture's
Raster8 blot(int side, double radius) {
  Raster8 picture(side, side, 4);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double dx = (x + 0.5) / side - 0.5 - kBlotX, dy = (y + 0.5) / side - 0.5 - kBlotY;
      const double share = std::clamp((radius - std::hypot(dx, dy)) * side + 0.5, 0.0, 1.0);
      std::uint8_t* p = picture.at(x, y);
      p[0] = p[1] = p[2] = 255;
      p[3] = static_cast<std::uint8_t>(255 * share + 0.5);
    }
  }
  return picture;
}

struct Pictures {
  hal::Image left, right;
};
Pictures blank(const StereoRig& rig, hal::PixelFormat format = hal::PixelFormat::kYuyv) {
  return {hal::Image(rig.left.width, rig.left.height, format),
          hal::Image(rig.right.width, rig.right.height, format)};
}

void render(Renderer& sut, const Scene& scene, Pictures& out, std::uint64_t frame = 0,
            Parallel* parallel = nullptr) {
  Serial serial;
  sut.render(scene, {}, 0.1 * static_cast<double>(frame), frame, parallel ? *parallel : serial,
             target_of(out.left), target_of(out.right));
}

// Centroid of the light in the green channel.
Eigen::Vector2d centroid(const Renderer& sut, Eye eye) {
  const Intrinsics& camera = eye == Eye::kLeft ? sut.rig().left : sut.rig().right;
  double sum = 0, x_sum = 0, y_sum = 0;
  const Float4* p = sut.light(eye);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x, ++p) {
      const double w = double{(*p)[1]};
      sum += w, x_sum += w * x, y_sum += w * y;
    }
  }
  return {x_sum / sum, y_sum / sum};
}

// The same by exact projection: the mean of the projections of the blot's points, each weighted by
// the area that it covers on the image (numeric Jacobian).
Eigen::Vector2d projected_centroid(const Intrinsics& camera, const auto& camera_from_target,
                                   double size_m, double radius) {
  constexpr int kSteps = 120;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weight = 0;
  const auto pixel = [&](double x, double y) {
    return *camera.project(camera_from_target(Eigen::Vector3d(x * size_m, y * size_m, 0)));
  };
  for (int i = 0; i < kSteps; ++i) {
    for (int k = 0; k < kSteps; ++k) {
      const double dx = radius * ((2 * i + 1.0) / kSteps - 1);
      const double dy = radius * ((2 * k + 1.0) / kSteps - 1);
      if (std::hypot(dx, dy) > radius) continue;
      const double x = kBlotX + dx, y = kBlotY + dy, h = 1e-4;
      const Eigen::Vector2d px = (pixel(x + h, y) - pixel(x - h, y)) / (2 * h);
      const Eigen::Vector2d py = (pixel(x, y + h) - pixel(x, y - h)) / (2 * h);
      const double area = std::abs(px.x() * py.y() - px.y() * py.x());
      sum += area * pixel(x, y);
      weight += area;
    }
  }
  return sum / weight;
}

void expect_exact_places(StereoRig rig, int texture_side) {
  std::vector<Texture> textures;
  constexpr double kRadius = 0.3;
  textures.emplace_back(blot(texture_side, kRadius), Texture::Edge::kClamp);
  Renderer sut(rig, std::move(textures), clean(), 1);
  Pictures out = blank(rig);
  Random random(3);
  const auto within = [&](double half) { return (2 * random.uniform() - 1) * half; };
  for (int trial = 0; trial < 12; ++trial) {
    Scene scene;
    SceneObject object;
    object.size_m = {0.12, 0.12};
    object.pose.translation = {0.06 + within(0.03), within(0.04), 0.55 + within(0.15)};
    object.pose.rotation = quaternion_from_rpy(within(0.7), within(0.7), within(0.8));
    scene.objects.push_back(object);
    render(sut, scene, out);
    const Transform<LeftCamera, Target> left{object.pose.rotation, object.pose.translation};
    const Transform<RightCamera, Target> right = rig.right_from_left * left;
    const Eigen::Vector2d miss_left =
        centroid(sut, Eye::kLeft) - projected_centroid(rig.left, left, 0.12, kRadius);
    const Eigen::Vector2d miss_right =
        centroid(sut, Eye::kRight) - projected_centroid(rig.right, right, 0.12, kRadius);
    EXPECT_LT(miss_left.norm(), 0.02) << "texture " << texture_side << " trial " << trial;
    EXPECT_LT(miss_right.norm(), 0.02) << "texture " << texture_side << " trial " << trial;
  }
}

TEST(Renderer, PutsACoarseTextureWhereExactProjectionPutsIt) {
  expect_exact_places(small_rig(), 37);
}
TEST(Renderer, PutsAFineTextureWhereExactProjectionPutsIt) {
  expect_exact_places(small_rig(), 512);
}

TEST(Renderer, PutsItThereThroughABrownLensToo) {
  StereoRig rig = small_rig();
  rig.left.distortion = rig.right.distortion = Distortion::kBrown;
  rig.left.coefficients = rig.right.coefficients = {-0.2, 0.05, 0.001, -0.0015, 0};
  expect_exact_places(rig, 128);
}

TEST(Renderer, PutsItThereThroughAFisheyeToo) {
  StereoRig rig = small_rig();
  rig.left.distortion = rig.right.distortion = Distortion::kFisheye;
  rig.left.coefficients = rig.right.coefficients = {-0.01, 0.003, -0.001, 0, 0};
  expect_exact_places(rig, 128);
}

TEST(Renderer, PutsItThereThroughAFlatPortToo) {
  StereoRig rig = small_rig();
  rig.left.port = FlatPort{.normal = {0, 0, 1}, .distance_m = 0.03, .thickness_m = 0.01};
  rig.right.port = FlatPort{.normal = Eigen::Vector3d(0.05, -0.08, 1).normalized(),
                            .distance_m = 0.09,
                            .thickness_m = 0.02};
  expect_exact_places(rig, 128);
  rig.right.distortion = Distortion::kBrown;
  rig.right.coefficients = {-0.2, 0.05, 0.001, -0.0015, 0};
  expect_exact_places(rig, 128);
}

// Moves of a tenth of a pixel have to move the picture by a tenth of a pixel, each of them.
TEST(Renderer, FollowsMovesBelowAPixelWithoutSteps) {
  const StereoRig rig = small_rig();
  std::vector<Texture> textures;
  textures.emplace_back(blot(200, 0.3), Texture::Edge::kClamp);
  Renderer sut(rig, std::move(textures), clean(), 1);
  Pictures out = blank(rig);
  for (int i = 0; i < 20; ++i) {
    Scene scene;
    SceneObject object;
    object.size_m = {0.1, 0.1};
    object.pose.translation = {0.1 * i / 320 * 0.5, 0, 0.5};
    scene.objects.push_back(object);
    render(sut, scene, out);
    const double expected = rig.left.cx + 320 * 0.1 * kBlotX / 0.5 + 0.1 * i;
    EXPECT_NEAR(centroid(sut, Eye::kLeft).x(), expected, 0.004) << i;
  }
}

TEST(Renderer, EdgesOfAnOpaqueRectangleCoverWhatTheyCover) {
  const StereoRig rig = small_rig();
  Raster8 white(4, 4, 1);
  std::fill(white.samples.begin(), white.samples.end(), std::uint8_t{255});
  std::vector<Texture> textures;
  textures.emplace_back(white, Texture::Edge::kClamp);
  Renderer sut(rig, std::move(textures), clean(), 1);
  Pictures out = blank(rig);
  for (const double roll : {0.0, 0.2, 0.7}) {
    Scene scene;
    SceneObject object;
    object.size_m = {0.11, 0.07};
    object.pose.translation = {0.001, 0.002, 0.5};
    object.pose.rotation = quaternion_from_rpy(0, 0, roll);
    scene.objects.push_back(object);
    render(sut, scene, out);
    double area = 0;
    for (int i = 0; i < 320 * 240; ++i) area += double{sut.light(Eye::kLeft)[i][3]};
    EXPECT_NEAR(area, 0.11 * 0.07 * 640 * 640, 3) << roll;  // of 3154 pixels
  }
}

// A fine texture far away must not alias: its picture's mean is the texture's mean and the pixels
// hardly differ; seen at a slant neither.
TEST(Renderer, AFarFineTextureMeltsIntoItsMean) {
  const StereoRig rig = small_rig();
  Raster8 checks(256, 256, 1);
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x) *checks.at(x, y) = (x / 2 + y / 2) % 2 ? 255 : 0;
  std::vector<Texture> textures;
  textures.emplace_back(checks, Texture::Edge::kTile);
  Renderer sut(rig, std::move(textures), clean(), 1);
  Pictures out = blank(rig);
  for (const double slant : {0.0, 1.0}) {
    Scene scene;
    SceneObject wall;
    wall.size_m = {50, 50}, wall.tile_m = 0.2;
    wall.pose.translation = {0, 0, 3};
    wall.pose.rotation = quaternion_from_rpy(slant, 0, 0);
    scene.background.push_back(wall);
    render(sut, scene, out);
    double worst = 0;
    for (int i = 320 * 100; i < 320 * 140; ++i)
      worst = std::max(worst, std::abs(double{sut.light(Eye::kLeft)[i][1]} - 0.5));
    EXPECT_LT(worst, 0.12) << slant;
  }
}

TEST(Renderer, WaterActsByTheDistanceAlongTheRay) {
  const StereoRig rig = small_rig();
  Raster8 grey(1, 1, 1);
  grey.samples = {188};
  std::vector<Texture> textures;
  textures.emplace_back(grey, Texture::Edge::kTile);
  Renderer sut(rig, std::move(textures), clean(), 1);
  Pictures out = blank(rig);
  Scene scene;
  SceneObject wall;
  wall.size_m = {50, 50}, wall.tile_m = 1;
  wall.pose.translation = {0, 0, 1.3};
  scene.background.push_back(wall);
  scene.water = coastal_water();
  render(sut, scene, out);
  const double albedo = double{linear_from_srgb(188 / 255.0f)};
  for (const auto& [x, y] : {std::pair{160, 120}, {5, 7}, {310, 230}}) {
    const double range_m = 1.3 * rig.left.ray({x, y}).norm();
    for (int c = 0; c < 3; ++c) {
      const auto i = static_cast<std::size_t>(c);
      const double expected =
          albedo * std::exp(-scene.water.attenuation_per_m[i] * range_m) +
          scene.water.veil[i] * (1 - std::exp(-scene.water.backscatter_per_m[i] * range_m));
      EXPECT_NEAR(double{sut.light(Eye::kLeft)[y * 320 + x][c]}, expected, 2e-4);
    }
  }
}

// Threads that take pieces in turn from the last to the first: any order must do.
class Backwards final : public Parallel {
 public:
  int workers() const override { return 3; }
  void run(int n, void (*work)(void*, int, int), void* context) override {
    std::vector<std::thread> threads;
    for (int w = 0; w < 3; ++w) {
      threads.emplace_back([=] {
        for (int i = n - 1 - w; i >= 0; i -= 3) work(context, i, w);
      });
    }
    for (auto& t : threads) t.join();
  }
};

Scene busy_scene() {
  Scene scene;
  SceneObject floor;
  floor.tile_m = 0.6, floor.size_m = {50, 50};
  floor.pose.translation = {0, 0.5, 1};
  floor.pose.rotation = quaternion_from_rpy(-1.0, 0, 0);
  scene.background.push_back(floor);
  for (int i = 0; i < 3; ++i) {
    SceneObject object;
    object.texture = 1, object.size_m = {0.2, 0.15};
    object.pose.translation = {0.05 * i, -0.03 * i, 0.5 + 0.1 * i};
    object.pose.rotation = quaternion_from_rpy(0.2 * i, -0.3, 0.1);
    scene.objects.push_back(object);
  }
  scene.water = turbid_water();
  scene.light = {20, 0.5, {0.1, 0.2, 1}, {1, 1, 1}, 0.8, 0.3};
  scene.particles.count = 200;
  return scene;
}

std::vector<Texture> busy_textures() {
  std::vector<Texture> textures;
  textures.emplace_back(pebbles_picture(256, 3), Texture::Edge::kTile);
  textures.emplace_back(blot(128, 0.3), Texture::Edge::kClamp);
  return textures;
}

TEST(Renderer, RepeatsBitForBitOnAnyNumberOfThreads) {
  const StereoRig rig = small_rig();
  RendererConfig config;
  config.blur_x_px = 1.2;
  Renderer one(rig, busy_textures(), config, 9);
  Renderer other(rig, busy_textures(), config, 9);
  Pictures a = blank(rig), b = blank(rig), c = blank(rig);
  Backwards threads;
  render(one, busy_scene(), a, 5);
  render(other, busy_scene(), c, 4, &threads);
  render(other, busy_scene(), b, 5, &threads);
  EXPECT_TRUE(std::ranges::equal(a.left.bytes(), b.left.bytes()));
  EXPECT_TRUE(std::ranges::equal(a.right.bytes(), b.right.bytes()));
  EXPECT_FALSE(std::ranges::equal(a.left.bytes(), c.left.bytes()));
  Renderer stranger(rig, busy_textures(), config, 10);
  render(stranger, busy_scene(), c, 5);
  EXPECT_FALSE(std::ranges::equal(a.left.bytes(), c.left.bytes()));
}

// Rows of open water are done once where nothing is added to them; planar pictures do each row.
// A vehicle that strays may look along the bottom, which then is endlessly far.
TEST(Renderer, LooksAlongASurfaceWithoutHarm) {
  StereoRig rig = small_rig();
  rig.left.cy = rig.right.cy = 120;  // a row of pixels that looks straight ahead
  Renderer sut(rig, busy_textures(), {}, 1);
  Scene scene = busy_scene();
  Pictures out = blank(rig);
  Serial serial;
  for (const double pitch : {-1.5707963267948966, -1.57079632, -1.5708, 1.5707963267948966}) {
    scene.background[0].pose.rotation = quaternion_from_rpy(pitch, 0, 0);
    sut.render(scene, {}, 0, 0, serial, target_of(out.left), target_of(out.right));
    for (int at = 0; at < rig.left.width * rig.left.height; ++at) {
      ASSERT_TRUE(std::isfinite(sut.light(Eye::kLeft)[at][1])) << pitch << " " << at;
    }
  }
}

TEST(Renderer, RowsThatRepeatAreTheRowsThemselves) {
  std::vector<Texture> textures;
  textures.emplace_back(blot(64, 0.3), Texture::Edge::kClamp);
  Renderer sut(small_rig(), std::move(textures), clean(), 1);
  Scene scene;
  scene.objects.push_back({0, {Eigen::Quaterniond::Identity(), {0.05, 0.1, 0.6}}, {0.2, 0.2}, 0});
  Pictures packed = blank(small_rig());
  Pictures planar = blank(small_rig(), hal::PixelFormat::kYuv422);
  render(sut, scene, packed);
  render(sut, scene, planar);
  int bright = 0;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      const std::uint8_t luma = packed.left.row(0, y)[2 * x];
      ASSERT_EQ(luma, planar.left.row(0, y)[x]) << x << ", " << y;
      ASSERT_EQ(packed.right.row(0, y)[2 * x], planar.right.row(0, y)[x]) << x << ", " << y;
      bright += luma > 150;
    }
  }
  EXPECT_GT(bright, 1000);
}

TEST(Renderer, EveryFormatSaysTheSameWithinItsChroma) {
  const StereoRig rig = small_rig();
  Renderer sut(rig, busy_textures(), clean(), 9);
  Scene scene = busy_scene();
  Pictures truth = blank(rig, hal::PixelFormat::kRgb24);
  render(sut, scene, truth);
  using F = hal::PixelFormat;
  for (const F format : {F::kYuyv, F::kUyvy, F::kNv12, F::kYuv422, F::kYuv420, F::kYuv444}) {
    for (const auto range : {hal::ColourRange::kLimited, hal::ColourRange::kFull}) {
      Pictures out{hal::Image(320, 240, format, hal::ColourMatrix::kBt709, range),
                   hal::Image(320, 240, format, hal::ColourMatrix::kBt601, range)};
      render(sut, scene, out);
      double error = 0;
      for (int y = 0; y < 240; ++y) {
        for (int x = 0; x < 320; ++x) {
          const auto a = hal::rgb_at(out.left.view(), x, y),
                     b = hal::rgb_at(truth.left.view(), x, y);
          const auto c = hal::rgb_at(out.right.view(), x, y),
                     d = hal::rgb_at(truth.right.view(), x, y);
          error +=
              std::abs(a.g - b.g) + std::abs(a.r - b.r) + std::abs(c.g - d.g) + std::abs(c.b - d.b);
        }
      }
      EXPECT_LT(error / (4 * 320 * 240), 2.0) << hal::to_string(format);
    }
  }
}

TEST(Renderer, TheNearerObjectHidesTheFarther) {
  const StereoRig rig = small_rig();
  std::vector<Texture> textures;
  Raster8 red(1, 1, 3), green(1, 1, 3);
  red.samples = {255, 0, 0}, green.samples = {0, 255, 0};
  textures.emplace_back(red, Texture::Edge::kClamp);
  textures.emplace_back(green, Texture::Edge::kClamp);
  Renderer sut(rig, std::move(textures), clean(), 1);
  Pictures out = blank(rig);
  Scene scene;
  SceneObject near, far;
  near.texture = 0, near.size_m = {0.1, 0.1}, near.pose.translation = {0, 0, 0.4};
  far.texture = 1, far.size_m = {1, 1}, far.pose.translation = {0, 0, 0.8};
  for (const bool swapped : {false, true}) {
    scene.objects = swapped ? std::vector{near, far} : std::vector{far, near};
    render(sut, scene, out);
    EXPECT_EQ(sut.light(Eye::kLeft)[120 * 320 + 160][0], 1.0f);
    EXPECT_EQ(sut.light(Eye::kLeft)[120 * 320 + 160][1], 0.0f);
    EXPECT_EQ(sut.light(Eye::kLeft)[20 * 320 + 160][1], 1.0f);
  }
}

TEST(Renderer, ThePhotoShowsTheTargetSquarelyAndTheMaskItsSize) {
  const StereoRig rig = small_rig();
  Renderer sut(rig, busy_textures(), RendererConfig{}, 1);
  Scene scene = busy_scene();
  scene.water = Water{};
  Serial serial;
  const TargetPhoto photo = make_photo(sut, scene, {}, 1, {0.1, 0.1}, 0.4, serial);
  int left = 320, right = -1;
  double x_sum = 0, count = 0;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      if (!*photo.mask.at(x, y)) continue;
      left = std::min(left, x), right = std::max(right, x);
      x_sum += x, count += 1;
    }
  }
  EXPECT_NEAR(right - left + 1, 320 * 0.1 * 0.6 / 0.4, 1.01);  // the blot is 0.6 of the side wide
  EXPECT_NEAR(x_sum / count, rig.left.cx + 320 * 0.1 * kBlotX / 0.4, 0.2);
  const auto at = [&](const hal::Image& image, int x, int y) {
    return hal::yuv_at(image.view(), x, y);
  };
  const int bx = static_cast<int>(x_sum / count);
  EXPECT_NE(at(photo.target, bx, 113).y, at(photo.background, bx, 113).y);
}

TEST(Assets, EveryPhotographIsCutToItsSilhouette) {
  const std::string folder = assets_folder();
  if (!assets_present(folder)) GTEST_SKIP() << "no photographs in " << folder << ": make assets";
  for (const Creature& creature : creatures()) {
    const auto picture = read_stamp(folder + "/" + std::string(creature.picture));
    ASSERT_TRUE(picture) << picture.error().text;
    double covered = 0;
    for (int y = 0; y < picture->height; ++y)
      for (int x = 0; x < picture->width; ++x) covered += picture->at(x, y)[3] >= 128;
    EXPECT_GT(covered / (picture->width * picture->height), 0.05) << creature.name;
    bool top = false;
    for (int x = 0; x < picture->width; ++x) top |= picture->at(x, 0)[3] >= 128;
    EXPECT_TRUE(top) << creature.name;
  }
}

TEST(Assets, TheGravelRepeatsWithoutASeam) {
  const std::string folder = assets_folder();
  if (!assets_present(folder)) GTEST_SKIP() << "no photographs in " << folder << ": make assets";
  const auto gravel = read_gravel(folder + "/gravel.png");
  ASSERT_TRUE(gravel) << gravel.error().text;
  const int side = gravel->width;
  double seam = 0, inside = 0;
  for (int y = 0; y < side; ++y) {
    seam += std::abs(gravel->at(0, y)[1] - gravel->at(side - 1, y)[1]);
    inside += std::abs(gravel->at(side / 2, y)[1] - gravel->at(side / 2 - 1, y)[1]);
  }
  EXPECT_LT(seam, 1.4 * inside);
}

}  // namespace
}  // namespace gannet::world
