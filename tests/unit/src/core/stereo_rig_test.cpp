#include "src/core/stereo_rig.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "platform/base/random.hpp"

namespace gannet {
namespace {

Intrinsics pinhole() {
  Intrinsics camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = 640;
  camera.fy = 630;
  camera.cx = 319.5;
  camera.cy = 239.5;
  return camera;
}

Intrinsics brown(std::array<double, 5> k) {
  Intrinsics camera = pinhole();
  camera.distortion = Distortion::kBrown;
  camera.coefficients = k;
  return camera;
}

Intrinsics fisheye(std::array<double, 5> k) {
  Intrinsics camera = pinhole();
  camera.fx = camera.fy = 285;
  camera.distortion = Distortion::kFisheye;
  camera.coefficients = k;
  return camera;
}

StereoRig good_rig() {
  StereoRig rig;
  rig.left = rig.right = pinhole();
  rig.right_from_left.translation = {-0.12, 0, 0};
  return rig;
}

std::vector<Intrinsics> lenses() {
  return {pinhole(),
          brown({-0.28, 0.09, 0, 0, 0}),
          brown({-0.32, 0.14, 0.0011, -0.0007, -0.03}),
          brown({0.12, -0.21, -0.002, 0.003, 0.15}),
          fisheye({-0.01, 0.02, -0.004, 0.0007, 0}),
          fisheye({0.0034, 0.0007, -0.0017, 0.0002, 0})};
}

TEST(Intrinsics, ray_is_the_inverse_of_project) {
  Random random(1);
  for (const Intrinsics& sut : lenses()) {
    const double reach = std::min(0.9, 0.95 * sut.valid_radius());
    for (int i = 0; i < 300; ++i) {
      const double r = reach * random.uniform();
      const double angle = 6.2831853 * random.uniform();
      const Eigen::Vector3d ray(r * std::cos(angle), r * std::sin(angle), 1);
      const auto pixel = sut.project((0.3 + 2 * random.uniform()) * ray);
      ASSERT_TRUE(pixel);
      EXPECT_LT((sut.ray(*pixel) - ray).norm(), 1e-9) << r;
    }
  }
}

TEST(Intrinsics, project_is_the_inverse_of_ray_for_each_pixel_in_reach) {
  for (const Intrinsics& sut : lenses()) {
    for (double v = 0; v < 480; v += 31) {
      for (double u = 0; u < 640; u += 37) {
        const Eigen::Vector3d ray = sut.ray({u, v});
        if (ray.head<2>().norm() > 0.999 * std::min(sut.valid_radius(), 10.)) continue;
        const auto pixel = sut.project(ray);
        ASSERT_TRUE(pixel) << u << " " << v;
        EXPECT_LT((*pixel - Eigen::Vector2d(u, v)).norm(), 1e-6) << u << " " << v;
      }
    }
  }
}

// By hand from Brown's equations at (0.5, 0.25): r² = 0.3125, radial 1 − 0.1·r² + 0.02·r⁴ − r⁶/100.
TEST(Intrinsics, brown_follows_the_published_order_of_coefficients) {
  const Intrinsics sut = brown({-0.1, 0.02, 0.001, 0.002, -0.01});
  const double t = 0.3125;
  const double radial = 1 - 0.1 * t + 0.02 * t * t - 0.01 * t * t * t;
  const double x = 0.5 * radial + 2 * 0.001 * 0.125 + 0.002 * (t + 2 * 0.25);
  const double y = 0.25 * radial + 0.001 * (t + 2 * 0.0625) + 2 * 0.002 * 0.125;
  const auto pixel = sut.project({1.0, 0.5, 2.0});
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x(), 640 * x + 319.5, 1e-9);
  EXPECT_NEAR(pixel->y(), 630 * y + 239.5, 1e-9);
}

TEST(Intrinsics, fisheye_without_coefficients_is_equidistant) {
  const Intrinsics sut = fisheye({});
  for (const double angle : {0.1, 0.5, 1.0, 1.3}) {
    const auto pixel = sut.project({std::sin(angle), 0, std::cos(angle)});
    ASSERT_TRUE(pixel) << angle;
    EXPECT_NEAR(pixel->x() - sut.cx, sut.fx * angle, 1e-9);
  }
}

TEST(Intrinsics, points_behind_the_camera_have_no_pixel) {
  for (const Intrinsics& sut : lenses()) {
    EXPECT_FALSE(sut.project({0.1, 0.1, -1}));
    EXPECT_FALSE(sut.project({0.1, 0.1, 0}));
    EXPECT_FALSE(sut.project({0.1, 0.1, std::numeric_limits<double>::quiet_NaN()}));
  }
}

// r(1 − 0.3 r²) turns at 1 − 0.9 r² = 0.
TEST(Intrinsics, valid_radius_is_where_the_radius_turns_back) {
  const Intrinsics sut = brown({-0.3, 0, 0, 0, 0});
  EXPECT_NEAR(sut.valid_radius(), std::sqrt(1 / 0.9), 1e-9);
  EXPECT_TRUE(sut.project({1.05, 0, 1}));
  EXPECT_FALSE(sut.project({1.06, 0, 1}));
  EXPECT_TRUE(std::isinf(pinhole().valid_radius()));
}

TEST(Intrinsics, radius_grows_everywhere_below_valid_radius_and_turns_there) {
  Random random(7);
  int turned = 0;
  for (int i = 0; i < 400; ++i) {
    std::array<double, 5> k{};
    for (double& c : k) c = 0.8 * (2 * random.uniform() - 1);
    const bool bent = i % 2 == 0;
    if (bent) k[2] = k[3] = 0;  // the tangential part is not radial
    const Intrinsics sut = bent ? brown(k) : fisheye(k);
    const double end = sut.valid_radius();
    double before = -1;
    for (int j = 0; j <= 400; ++j) {
      const double now = sut.distort({end * j / 400 * (1 - 1e-9), 0}).x();
      ASSERT_GT(now, before) << i << " " << j;
      before = now;
    }
    if (end < 9) {
      ++turned;
      EXPECT_LT(sut.distort({end * 1.001, 0}).x(), sut.distort({end, 0}).x()) << i;
    }
  }
  EXPECT_GT(turned, 100);
}

TEST(Rig, a_good_one_passes) { EXPECT_TRUE(check(good_rig())); }

TEST(Rig, each_fault_is_named_by_its_key) {
  const auto keys_of = [](auto spoil) {
    StereoRig rig = good_rig();
    spoil(rig);
    std::string keys;
    for (const RigProblem& problem : problems_of(rig)) keys += problem.key + " ";
    EXPECT_FALSE(check(rig));
    return keys;
  };
  EXPECT_EQ(keys_of([](StereoRig& r) { r.left.fx = 0; }), "left.fx ");
  EXPECT_EQ(keys_of([](StereoRig& r) { r.right.fy = -3; }), "right.fy ");
  EXPECT_EQ(keys_of([](StereoRig& r) { r.right.width = 3; }), "right.width ");
  EXPECT_EQ(keys_of([](StereoRig& r) { r.left.cx = 5000; }), "left.cx ");
  EXPECT_EQ(keys_of([](StereoRig& r) { r.right_from_left.translation.setZero(); }),
            "right_from_left.translation_m ");
  EXPECT_EQ(keys_of([](StereoRig& r) { r.right_from_left.rotation.w() = 2; }),
            "right_from_left.rotation ");
  EXPECT_EQ(keys_of([](StereoRig& r) {
              r.left.distortion = Distortion::kBrown;
              r.left.coefficients = {-30, 0, 0, 0, 0};
            }),
            "left.coefficients ");
  EXPECT_EQ(keys_of([](StereoRig& r) { r.left.fx = r.right.height = 0; }), "left.fx right.height ");
}

}  // namespace
}  // namespace gannet
