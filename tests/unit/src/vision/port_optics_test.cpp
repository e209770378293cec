// A port as the search sees it, against the exact solution, over the volume that is worked in:
// 0.4 to 1.5 m, the whole frame, all tilts, housings near and far, square and aslant.
#include "src/vision/port_optics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "platform/base/random.hpp"
#include "src/vision/hypothesis.hpp"
#include "tests/support/flat_scene.hpp"

namespace gannet::vision {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double either(Random& random, double reach) { return reach * (2 * random.uniform() - 1); }

struct Housing {
  const char* name;
  double distance_m, thickness_m;
  Vector3d normal;
  Distortion lens;
  double most_mm;  // of a point 0.1 m beside the target's middle, where it is worst
};

class PortView : public testing::TestWithParam<Housing> {
 protected:
  PortView() {
    FlatPort port;
    port.distance_m = GetParam().distance_m;
    port.thickness_m = GetParam().thickness_m;
    port.normal = GetParam().normal.normalized();
    for (Intrinsics* camera : {&rig.left, &rig.right}) {
      camera->width = 640;
      camera->height = 480;
      camera->fx = camera->fy = 640;  // 53° in air
      camera->cx = 319.5;
      camera->cy = 239.5;
      camera->port = port;
      camera->distortion = GetParam().lens;
      if (camera->distortion == Distortion::kBrown)
        camera->coefficients = {-0.2, 0.05, 8e-4, -5e-4, -0.01};
      if (camera->distortion == Distortion::kFisheye)
        camera->coefficients = {-0.02, 0.01, -0.004, 0.001};
    }
    rig.right_from_left.translation = {-0.12, 0, 0};
  }

  // Somewhere in the left camera's picture, its plane tilted by up to 45°.
  Transform<LeftCamera, Target> somewhere(Random& random) const {
    const double z = 0.4 + 1.1 * random.uniform();
    const auto line = rig.left.line({639 * random.uniform(), 479 * random.uniform()});
    auto pose = test::pose_at(0, 0, 1, either(random, 45), either(random, 45), either(random, 180));
    pose.translation = line->at_depth(z);
    return pose;
  }

  StereoRig rig;
};

// What the kernels compute, in double, so that the model is measured and not the rounding to cells.
std::optional<Vector2d> seen(const PlaneView& view, const CameraModel& model, double x, double y) {
  const auto h = [&](int k) { return static_cast<double>(view.h[k]); };
  const auto e = [&](int k) { return static_cast<double>(view.e[k]); };
  const auto n = [&](int k) { return static_cast<double>(view.port[k]); };
  const double r = std::sqrt((e(0) * x + e(1) * y + e(2)) * x + (e(3) * y + e(4)) * y + e(5));
  const double w = h(6) * x + h(7) * y + h(8) + r * n(2);
  const Vector2d at((h(0) * x + h(1) * y + h(2) + r * n(0)) / w,
                    (h(3) * x + h(4) * y + h(5) + r * n(1)) / w);
  if (!(w > 0)) return std::nullopt;
  if (!model.has_lens()) return at;
  const LensTable& lens = model.lens(0);
  const double s = at.squaredNorm() * static_cast<double>(lens.scale);
  if (!(s < LensTable::kSteps)) return std::nullopt;
  const int step = static_cast<int>(s);
  const double low = static_cast<double>(lens.factor[step]);
  const double factor = low + (static_cast<double>(lens.factor[step + 1]) - low) * (s - step);
  const double p1 = static_cast<double>(lens.p1), p2 = static_cast<double>(lens.p2);
  const double r2 = at.squaredNorm(), ab2 = 2 * at.x() * at.y();
  const Vector2d bent(at.x() * factor + p1 * ab2 + p2 * (r2 + 2 * at.x() * at.x()),
                      at.y() * factor + p1 * (r2 + 2 * at.y() * at.y()) + p2 * ab2);
  return Vector2d(640 * bent.x() + 319.5, 640 * bent.y() + 239.5);
}

struct Worst {
  double middle_px = 0;    // of the target's middle
  double reach_px = 0;     // of points 0.1 m about it
  double reach_mm = 0;     // what those pixels are at their distance
  double squares_px2 = 0;  // sum
  int points = 0;
};

TEST_P(PortView, shows_points_where_the_exact_solution_does) {
  const CameraModel left(rig.left, nullptr), right(rig.right, &rig.right_from_left);
  Random random(7);
  Worst worst;
  for (int i = 0; i < 2000; ++i) {
    const auto pose = somewhere(random);
    const Hypothesis q = Hypothesis::from(pose);
    for (const bool is_left : {true, false}) {
      const CameraModel& model = is_left ? left : right;
      const PlaneView view = model.view(q, 0.1f, 0, 640, 480, 640 * 480);
      for (int j = 0; j < 9; ++j) {
        const double angle = 0.785 * j, r = j == 0 ? 0 : 0.1;
        const double x = r * std::cos(angle), y = r * std::sin(angle);
        const Vector3d p = pose({x, y, 0});
        const auto exact =
            is_left ? rig.left.project(p) : rig.right.project(rig.right_from_left(p));
        if (!exact || exact->minCoeff() < 0 || exact->x() > 639 || exact->y() > 479) continue;
        const auto got = seen(view, model, x, y);
        ASSERT_TRUE(got) << exact->transpose();
        const double off = (*got - *exact).norm();
        if (j == 0) {
          worst.middle_px = std::max(worst.middle_px, off);
        } else {
          worst.reach_px = std::max(worst.reach_px, off);
          // 1.333: a pixel spans so much less in water.
          worst.reach_mm = std::max(worst.reach_mm, 1e3 * off * p.z() / (1.333 * 640));
          worst.squares_px2 += off * off;
          ++worst.points;
        }
      }
    }
  }
  std::printf("%s: middle %.4f px, 0.1 m off %.3f px, %.3f mm at worst, %.4f px rms\n",
              GetParam().name, worst.middle_px, worst.reach_px, worst.reach_mm,
              std::sqrt(worst.squares_px2 / worst.points));
  EXPECT_LT(worst.middle_px, 0.02);
  EXPECT_LT(worst.reach_mm, GetParam().most_mm);
  EXPECT_LT(std::sqrt(worst.squares_px2 / worst.points), 0.15);
  EXPECT_GT(worst.points, 10000);
}

// The same with the refraction folded into a pinhole that is right near the axis.
TEST_P(PortView, a_pinhole_would_be_wrong_by_far_more) {
  Random random(7);
  double worst_mm = 0;
  Intrinsics folded = rig.left;
  folded.port.reset();
  folded.fx *= 1.333;
  folded.fy *= 1.333;
  for (int i = 0; i < 500; ++i) {
    const Vector3d p = somewhere(random).translation;
    const Vector3d from_pupil = p - rig.left.port->pupil_m() * rig.left.port->normal;
    const auto pixel = folded.project(from_pupil), exact = rig.left.project(p);
    if (!pixel || !exact) continue;
    worst_mm = std::max(worst_mm, 1e3 * (*pixel - *exact).norm() * p.z() / (1.333 * 640));
  }
  EXPECT_GT(worst_mm, 5);
}

TEST_P(PortView, nothing_is_seen_of_a_target_that_reaches_into_the_glass) {
  const CameraModel sut(rig.left, nullptr);
  const double glass = GetParam().distance_m + GetParam().thickness_m;
  auto pose = test::pose_at(0, 0, 0, 45);
  for (const double beyond : {0.05, 0.12}) {
    pose.translation = (glass + beyond) * rig.left.port->normal;
    const PlaneView view = sut.view(Hypothesis::from(pose), 0.1f, 0, 640, 480, 640 * 480);
    float x[kLanes] = {}, y[kLanes] = {};
    std::int32_t index[kLanes];
    const int inside = sut.project(kScalarKernels, x, y, kLanes, view, 0, index);
    EXPECT_EQ(inside, beyond < 0.1 ? 0 : kLanes) << beyond;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Housings, PortView,
    testing::Values(Housing{"near", 0.01, 0.006, {0, 0, 1}, Distortion::kNone, 0.1},
                    Housing{"usual", 0.03, 0.01, {0.01, -0.02, 1}, Distortion::kNone, 0.3},
                    Housing{"far", 0.2, 0.004, {-0.012, -0.063, 0.998}, Distortion::kNone, 1.2},
                    Housing{"aslant", 0.05, 0.02, {0.2, 0.1, 1}, Distortion::kNone, 1.5},
                    Housing{"brown", 0.03, 0.01, {0.01, -0.02, 1}, Distortion::kBrown, 0.3},
                    Housing{"fisheye", 0.03, 0.01, {0.01, -0.02, 1}, Distortion::kFisheye, 0.3}),
    [](const auto& housing) { return std::string(housing.param.name); });

}  // namespace
}  // namespace gannet::vision
