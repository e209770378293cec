#include "src/core/flat_port.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "platform/base/random.hpp"
#include "src/core/stereo_rig.hpp"

namespace gannet {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double either(Random& random, double reach) { return reach * (2 * random.uniform() - 1); }

FlatPort tilted(double x, double y) {
  FlatPort port;
  port.normal = Vector3d(x, y, 1).normalized();
  return port;
}

// Housings as they are and some that nobody builds.
std::vector<FlatPort> ports() {
  FlatPort far_off = tilted(-0.012, -0.063);
  far_off.distance_m = 0.2;
  far_off.thickness_m = 0.004;
  far_off.glass_index = 1.52;
  FlatPort deep = tilted(0.3, 0.2);
  deep.distance_m = 0.06;
  deep.thickness_m = 0.03;
  FlatPort touching;
  touching.distance_m = 0;
  FlatPort film;
  film.thickness_m = 0;
  FlatPort grazing;  // a millimetre of air: rays bend hard at its edge
  grazing.distance_m = 0.001;
  return {FlatPort{}, far_off, deep, touching, film, grazing};
}

// A point in the water that the camera's front sees.
Vector3d point_beyond(const FlatPort& port, Random& random) {
  const double depth = 0.05 + 2 * random.uniform();
  const Vector3d across(either(random, 0.5) * depth, either(random, 0.5) * depth, 0);
  return (port.distance_m + port.thickness_m + depth) * port.normal + across -
         across.dot(port.normal) * port.normal;
}

TEST(FlatPort, the_line_of_a_points_ray_meets_the_point) {
  Random random(1);
  for (const FlatPort& sut : ports()) {
    for (int i = 0; i < 500; ++i) {
      const Vector3d point = point_beyond(sut, random);
      const auto ray = sut.air_ray(point);
      ASSERT_TRUE(ray);
      const auto line = sut.line(*ray);
      if (!line) continue;  // straight ahead of a steep port, away from the camera's front
      const Vector3d to_point = point - line->origin;
      EXPECT_LT(to_point.cross(line->direction).norm() / line->direction.norm(), 1e-9);
      EXPECT_GT(to_point.dot(line->direction), 0);
      EXPECT_NEAR(sut.normal.dot(line->origin), sut.distance_m + sut.thickness_m, 1e-12);
    }
  }
}

// Fermat: light takes the way that is shortest in time, over crossings of both faces.
TEST(FlatPort, no_other_way_to_a_point_is_quicker) {
  Random random(2);
  for (const FlatPort& sut : ports()) {
    for (int i = 0; i < 100; ++i) {
      const Vector3d point = point_beyond(sut, random);
      const Vector3d ray = *sut.air_ray(point);
      const auto line = sut.line(ray);
      if (!line) continue;
      const Vector3d inner = ray * (sut.distance_m / sut.normal.dot(ray));
      const auto time = [&](const Vector3d& first, const Vector3d& second) {
        return sut.air_index * first.norm() + sut.glass_index * (second - first).norm() +
               sut.water_index * (point - second).norm();
      };
      const double least = time(inner, line->origin);
      for (int j = 0; j < 20; ++j) {
        const auto beside = [&](const Vector3d& at) {
          const Vector3d off(either(random, 1e-3), either(random, 1e-3), either(random, 1e-3));
          return Vector3d(at + off - off.dot(sut.normal) * sut.normal);
        };
        EXPECT_GE(time(beside(inner), beside(line->origin)), least - 1e-13);
      }
    }
  }
}

TEST(FlatPort, sines_are_as_the_indices_say) {
  FlatPort sut;
  sut.air_index = 1.003;
  for (const double angle : {0.05, 0.3, 0.7, 1.2}) {
    const auto line = sut.line({std::sin(angle), 0, std::cos(angle)});
    ASSERT_TRUE(line);
    const double in_water = std::atan(line->direction.x());
    EXPECT_NEAR(1.333 * std::sin(in_water), 1.003 * std::sin(angle), 1e-12);
    const double in_glass = std::asin(1.003 * std::sin(angle) / 1.49);
    EXPECT_NEAR(line->origin.x(), 0.02 * std::tan(angle) + 0.01 * std::tan(in_glass), 1e-12);
  }
}

TEST(FlatPort, without_differences_of_index_light_goes_straight) {
  Random random(3);
  for (FlatPort sut : ports()) {
    sut.air_index = sut.glass_index = sut.water_index = 1.333;
    EXPECT_NEAR(sut.pupil_m(), 0, 1e-12);
    for (int i = 0; i < 200; ++i) {
      const Vector3d point = point_beyond(sut, random);
      EXPECT_LT(sut.air_ray(point)->normalized().cross(point.normalized()).norm(), 1e-12);
    }
  }
}

TEST(FlatPort, turning_all_about_the_axis_turns_the_ray) {
  Random random(4);
  const FlatPort sut;
  for (int i = 0; i < 100; ++i) {
    const Vector3d point = point_beyond(sut, random);
    const Eigen::AngleAxisd turn(6.3 * random.uniform(), sut.normal);
    EXPECT_LT((*sut.air_ray(turn * point) - turn * *sut.air_ray(point)).norm(), 1e-12);
  }
}

TEST(FlatPort, a_glass_of_no_thickness_is_the_limit_of_thin_ones) {
  FlatPort film, thin;
  film.thickness_m = 0;
  const Vector3d point(0.2, -0.1, 0.5);
  double before = 1;
  for (const double thickness : {1e-3, 1e-4, 1e-5, 1e-6}) {
    thin.thickness_m = thickness;
    const double off = (*thin.air_ray(point) - *film.air_ray(point)).norm();
    EXPECT_LT(off, 0.2 * before);
    before = off;
  }
  EXPECT_LT(before, 1e-5);
}

TEST(FlatPort, lines_near_the_axis_meet_at_the_pupil) {
  const FlatPort sut;
  for (const double slope : {1e-3, 1e-4}) {
    const auto line = *sut.line({slope, 0, 1});
    EXPECT_NEAR(line.at_depth(sut.pupil_m()).x(), 0, 1e-8);
  }
  // Farther out they do not: no pinhole is right at every distance.
  const auto line = *sut.line({0.5, 0, 1});
  EXPECT_GT(std::abs(line.at_depth(sut.pupil_m()).x()), 2e-4);
}

TEST(FlatPort, what_light_cannot_reach_is_refused) {
  FlatPort sut;
  EXPECT_FALSE(sut.air_ray({0, 0, 0.03}));    // in the glass's face
  EXPECT_FALSE(sut.air_ray({0.1, 0, -0.2}));  // behind
  EXPECT_FALSE(sut.air_ray({0, std::numeric_limits<double>::quiet_NaN(), 1}));
  EXPECT_FALSE(sut.line({1, 0, 0}));  // along the glass
  EXPECT_FALSE(sut.line({0, 0, -1}));
  EXPECT_FALSE(sut.line(Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_TRUE(sut.line({1e3, 0, 1}));
  sut.water_index = 1;  // air again behind thick air: beyond 48.6° all is reflected
  sut.air_index = 1.333;
  EXPECT_TRUE(sut.line({std::tan(0.84), 0, 1}));
  EXPECT_FALSE(sut.line({std::tan(0.86), 0, 1}));
}

TEST(FlatPort, far_out_and_grazing_points_still_converge) {
  Random random(5);
  for (const FlatPort& sut : ports()) {
    for (int i = 0; i < 300; ++i) {
      const double depth = std::pow(10, either(random, 3));
      const double across = std::pow(10, either(random, 2) - 1);  // farther out doubles end
      const Vector3d u = sut.normal.unitOrthogonal();
      const Vector3d point = (sut.distance_m + sut.thickness_m + depth) * sut.normal + across * u;
      const auto ray = sut.air_ray(point);
      if (!ray) continue;  // touching: only what lies in the cone
      const double tangent = (*ray - sut.normal).norm();
      ASSERT_TRUE(std::isfinite(tangent));
      const double s = sut.air_index * std::sin(std::atan(tangent));
      const double in_glass = s / std::sqrt(sut.glass_index * sut.glass_index - s * s);
      const double in_water = s / std::sqrt(sut.water_index * sut.water_index - s * s);
      EXPECT_NEAR((sut.distance_m * tangent + sut.thickness_m * in_glass + depth * in_water),
                  across, 1e-8 * across + 1e-10);
    }
  }
}

Intrinsics camera_behind(const FlatPort& port) {
  Intrinsics camera;
  camera.width = 640, camera.height = 480;
  camera.fx = camera.fy = 640;
  camera.cx = 319.5, camera.cy = 239.5;
  camera.distortion = Distortion::kBrown;
  camera.coefficients = {-0.1, 0.02, 0.001, -0.0005, 0};
  camera.port = port;
  return camera;
}

TEST(Intrinsics, line_through_a_port_is_the_inverse_of_project) {
  for (const FlatPort& port : ports()) {
    const Intrinsics sut = camera_behind(port);
    for (double v = 0; v < 480; v += 31) {
      for (double u = 0; u < 640; u += 31) {
        const auto line = sut.line({u, v});
        ASSERT_TRUE(line) << u << " " << v;
        for (const double z : {0.4, 1.5}) {
          const auto pixel = sut.project(line->at_depth(z));
          ASSERT_TRUE(pixel);
          EXPECT_LT((*pixel - Vector2d(u, v)).norm(), 1e-6);
        }
      }
    }
  }
}

TEST(StereoRig, names_what_is_wrong_with_a_port) {
  const auto keys_of = [](auto&& change) {
    StereoRig rig;
    rig.left = rig.right = camera_behind(FlatPort{});
    rig.right_from_left.translation = {-0.12, 0, 0};
    change(*rig.right.port);
    std::string keys;
    for (const RigProblem& problem : problems_of(rig)) keys += problem.key + " ";
    return keys;
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(keys_of([](FlatPort&) {}), "");
  EXPECT_EQ(keys_of([](FlatPort& p) { p.normal *= 1.1; }), "right.port.normal ");
  EXPECT_EQ(keys_of([](FlatPort& p) {
              p.normal = {0.9, 0, std::sqrt(0.19)};
            }),
            "right.port.normal ");
  EXPECT_EQ(keys_of([](FlatPort& p) { p.distance_m = -0.01; }), "right.port.distance_m ");
  EXPECT_EQ(keys_of([](FlatPort& p) { p.thickness_m = kNan; }), "right.port.thickness_m ");
  EXPECT_EQ(keys_of([](FlatPort& p) { p.air_index = 0; }), "right.port.air_index ");
  EXPECT_EQ(keys_of([](FlatPort& p) { p.glass_index = 3; }), "right.port.glass_index ");
  EXPECT_EQ(keys_of([](FlatPort& p) { p.water_index = kNan; }), "right.port.water_index ");
}

}  // namespace
}  // namespace gannet
