#include "src/modeldb/model_facts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace gannet::modeldb {
namespace {

// A disc of 60 mm on a photo at 0.4 m; brightness by place in metres.
vision::PhotoPatch disc(const std::function<double(double, double)>& brightness) {
  vision::PhotoPatch p;
  p.name = "disc";
  p.width = p.height = 121;
  p.distance_m = 0.4;
  p.fx = p.fy = 800;
  p.centre_px = {60, 60};
  p.size_m = {0.06, 0.06};
  p.background = {20, 128, 128};
  for (int y = 0; y < p.height; ++y) {
    for (int x = 0; x < p.width; ++x) {
      const double at_x = (x - 60) * 0.0005, at_y = (y - 60) * 0.0005;
      p.yuv.push_back(static_cast<std::uint8_t>(std::lround(brightness(at_x, at_y))));
      p.yuv.insert(p.yuv.end(), {128, 128});
      p.mask.push_back(std::hypot(at_x, at_y) <= 0.03 ? 255 : 0);
    }
  }
  return p;
}

double uneven(double x, double y) {
  return 120 + 50 * std::sin(200 * x + 1) + 40 * std::sin(230 * y - 1);
}
StereoRig rig() {
  StereoRig out;
  for (Intrinsics* camera : {&out.left, &out.right}) {
    camera->width = 640, camera->height = 480;
    camera->fx = camera->fy = 640;
    camera->cx = 319.5, camera->cy = 239.5;
  }
  out.right_from_left.translation = {-0.12, 0, 0};
  out.hand_from_left.translation = {-0.06, 0, 0};
  return out;
}

TEST(ModelFacts, SigmaGrowsWithTheNoiseAndDepthIsWeakerThanPlace) {
  const auto little = least_sigma(disc(uneven), rig(), 0.5, 1);
  const auto much = least_sigma(disc(uneven), rig(), 0.5, 4);
  ASSERT_TRUE(little && much);
  const double factor = std::sqrt((16 + 1.0 / 12) / (1 + 1.0 / 12));
  for (int axis = 0; axis < 6; ++axis) EXPECT_NEAR((*much)[axis] / (*little)[axis], factor, 1e-6);
  EXPECT_GT((*little)[2], (*little)[1]);
}

// By hand: on brightness that rises to the right alone, x is left to itself and y is free.
TEST(ModelFacts, ATextureThatLeavesADirectionFreeHasNoSigma) {
  EXPECT_FALSE(least_sigma(disc([](double x, double) { return 128 + 2000 * x; }), rig(), 0.5, 1));
  EXPECT_FALSE(least_sigma(disc([](double, double) { return 128.0; }), rig(), 0.5, 1));
}

TEST(ModelFacts, ATargetBeyondBothImagesHasNoSigma) {
  StereoRig away = rig();
  away.left.cx = away.right.cx = -5000;
  EXPECT_FALSE(least_sigma(disc(uneven), away, 0.5, 1));
}

}  // namespace
}  // namespace gannet::modeldb
