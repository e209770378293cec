#include "src/vision/symmetry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace gannet::vision {
namespace {

constexpr double kPi = std::numbers::pi;

// A disc of 60 mm on a photo at 0.4 m; brightness by place in metres.
PhotoPatch disc(const std::function<double(double, double)>& brightness) {
  PhotoPatch p;
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
// Looks the same after half a turn, and only then.
double twofold(double x, double y) { return 120 + 90 * std::sin(200 * x) * std::sin(230 * y); }

TEST(Symmetry, UnturnedATargetIsLikeItself) {
  EXPECT_NEAR(likeness_when_rolled(disc(uneven), 0), 1, 1e-12);
}

TEST(Symmetry, AnUnevenTargetIsNotAmbiguous) {
  const auto patch =
      disc([](double x, double y) { return 130 + 3000 * x + 20 * std::sin(150 * y); });
  EXPECT_LT(likeness_when_rolled(patch, kPi), 0.9);
  EXPECT_FALSE(symmetry_of(patch).exists());
}

TEST(Symmetry, AHalfTurnThatShowsTheSameIsFound) {
  const auto rolls = symmetry_of(disc(twofold)).rolls;
  ASSERT_EQ(rolls.size(), 1u);
  EXPECT_NEAR(rolls[0], kPi, 1e-9);
}

TEST(Symmetry, RingsAreAmbiguousAtEveryRoll) {
  const auto patch =
      disc([](double x, double y) { return 120 + 80 * std::cos(300 * std::hypot(x, y)); });
  for (const double roll : {0.6, 1.5, 2.9}) EXPECT_GT(likeness_when_rolled(patch, roll), 0.97);
  EXPECT_TRUE(symmetry_of(patch).any_roll);
  EXPECT_TRUE(symmetry_of(patch).rolls.empty());
}

TEST(Symmetry, NothingToBeSeenIsLikeNothing) {
  EXPECT_EQ(likeness_when_rolled(disc([](double, double) { return 20.0; }), 1), 0);
}

using Pose = Transform<LeftCamera, Target>;

Pose rolled(double degrees) {
  return {quaternion_from_rpy(0.3, -0.2, 0) *
              Eigen::AngleAxisd(degrees * kPi / 180, Eigen::Vector3d::UnitZ()),
          {0.1, 0, 0.6}};
}

TEST(Symmetry, OfPosesThatLookAlikeTheNearestIsTaken) {
  const Symmetry quarter = {.rolls = {kPi / 2, kPi}};
  for (const double by : {90.0, -90.0, 180.0}) {
    const Pose got = nearest_equivalent(quarter, rolled(20 + by), rolled(14).rotation);
    EXPECT_LT(got.rotation.angularDistance(rolled(20).rotation), 1e-7) << by;
    EXPECT_EQ(got.translation, rolled(0).translation);
  }
}

TEST(Symmetry, WithoutAnyThePoseStays) {
  const Pose got = nearest_equivalent({}, rolled(170), rolled(0).rotation);
  EXPECT_EQ(got.rotation.coeffs(), rolled(170).rotation.coeffs());
}

TEST(Symmetry, WhereEveryRollLooksAlikeTheRollStaysAndTheTiltIsMeasured) {
  Symmetry rings;
  rings.any_roll = true;
  const Pose got = nearest_equivalent(rings, rolled(123), rolled(-41).rotation);
  EXPECT_LT(got.rotation.angularDistance(rolled(-41).rotation), 1e-7);
}

}  // namespace
}  // namespace gannet::vision
