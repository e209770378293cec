// Recognition through lenses that bend: pictures made with a pinhole and then warped by the lens
// models as published, written down here a second time, so that a fault in src/core's projection
// cannot cancel itself. Photo, background and frames all go through the lens; the targets stand
// towards the corners, where the lens bends most.
#include <gtest/gtest.h>

#include <cmath>

#include "src/track/recogniser.hpp"
#include "tests/support/flat_scene.hpp"
#include "tests/support/heap_calls.hpp"

namespace gannet {
namespace {

using Pose = Transform<LeftCamera, Target>;

// Distorted normalised coordinates, from the OpenCV documentation's formulas.
Eigen::Vector2d bend(const Intrinsics& lens, const Eigen::Vector2d& p) {
  const auto& c = lens.coefficients;
  const double x = p.x(), y = p.y(), r2 = x * x + y * y;
  if (lens.distortion == Distortion::kBrown) {
    const double radial = 1 + c[0] * r2 + c[1] * r2 * r2 + c[4] * r2 * r2 * r2;
    return {x * radial + 2 * c[2] * x * y + c[3] * (r2 + 2 * x * x),
            y * radial + c[2] * (r2 + 2 * y * y) + 2 * c[3] * x * y};
  }
  const double r = std::sqrt(r2);
  if (r < 1e-9) return p;
  const double t = std::atan(r), t2 = t * t;
  return p * (t * (1 + t2 * (c[0] + t2 * (c[1] + t2 * (c[2] + t2 * c[3])))) / r);
}

// The inverse by Newton's method with differences.
Eigen::Vector2d unbend(const Intrinsics& lens, const Eigen::Vector2d& bent) {
  Eigen::Vector2d p = bent;
  for (int i = 0; i < 30; ++i) {
    constexpr double kStep = 1e-6;
    const Eigen::Vector2d miss = bend(lens, p) - bent;
    Eigen::Matrix2d slope;
    slope.col(0) = (bend(lens, p + Eigen::Vector2d(kStep, 0)) - bend(lens, p)) / kStep;
    slope.col(1) = (bend(lens, p + Eigen::Vector2d(0, kStep)) - bend(lens, p)) / kStep;
    p -= slope.inverse() * miss;
  }
  return p;
}

test::Picture warp(const test::Picture& pinhole, const Intrinsics& from, const Intrinsics& lens) {
  test::Picture out = {lens.width, lens.height, {}, {}, {}};
  for (int row = 0; row < lens.height; ++row) {
    for (int col = 0; col < lens.width; ++col) {
      const Eigen::Vector2d p =
          unbend(lens, {(col - lens.cx) / lens.fx, (row - lens.cy) / lens.fy});
      const double u = from.fx * p.x() + from.cx, v = from.fy * p.y() + from.cy;
      const int i = static_cast<int>(u), j = static_cast<int>(v);
      EXPECT_TRUE(u >= 0 && v >= 0 && i + 1 < from.width && j + 1 < from.height) << u << " " << v;
      const auto sample = [&](const std::vector<std::uint8_t>& plane) {
        const auto at = [&](int x, int y) {
          return static_cast<double>(plane[static_cast<std::size_t>(y * from.width + x)]);
        };
        const double a = u - i, b = v - j;
        return static_cast<std::uint8_t>(
            std::lround((1 - b) * ((1 - a) * at(i, j) + a * at(i + 1, j)) +
                        b * ((1 - a) * at(i, j + 1) + a * at(i + 1, j + 1))));
      };
      out.y.push_back(sample(pinhole.y));
      out.u.push_back(sample(pinhole.u));
      out.v.push_back(sample(pinhole.v));
    }
  }
  return out;
}

struct Lens {
  const char* name;
  Distortion kind;
  std::array<double, 5> coefficients;
  double focal_px;
};

class ThroughALens : public testing::TestWithParam<Lens> {
 protected:
  void SetUp() override {
    if (!test::kCountsHeap) GTEST_SKIP() << "too slow under a sanitizer";
  }

  ThroughALens() {
    rig = pinhole.rig;
    for (Intrinsics* camera : {&rig.left, &rig.right}) {
      camera->fx = camera->fy = GetParam().focal_px;
      camera->distortion = GetParam().kind;
      camera->coefficients = GetParam().coefficients;
    }
    // Wide enough for what the lens sees; finer, so that warping adds no blur to speak of.
    for (Intrinsics* camera : {&pinhole.rig.left, &pinhole.rig.right}) {
      camera->fx = camera->fy = 1.5 * GetParam().focal_px;
      camera->width = 960;
      camera->height = 720;
      camera->cx = 479.5;
      camera->cy = 359.5;
    }
    pinhole.noise = 0;
  }

  test::Picture see(bool left, const Pose* pose) const {
    const Intrinsics& from = left ? pinhole.rig.left : pinhole.rig.right;
    return warp(pinhole.see(left, pose, 1), from, left ? rig.left : rig.right);
  }

  vision::PatchModel model() const {
    const Pose square = test::pose_at(0.06, 0.04, 0.4);
    const test::Picture photo = see(true, &square), empty = see(true, nullptr);
    const hal::ImageView background = empty.view();
    vision::PhotoInput input;
    input.target = photo.view();
    input.background = &background;
    input.name = "ellipse";
    return vision::make_patch_model(*vision::cut_out(input, rig.left), {}).value();
  }

  static track::Recognition find(const StereoRig& believed, const vision::PatchModel& model,
                                 const test::Picture& left, const test::Picture& right) {
    auto sut = track::Recogniser::create({}, believed, track::TargetKind::kModel).value();
    vision::PreparedFrame frame(left.width, left.height, sut->needs());
    EXPECT_TRUE(frame.prepare(left.view(), right.view()));
    EXPECT_TRUE(sut->set_model(model));
    Serial serial;
    return sut->recognise(frame, nullptr, {}, serial);
  }

  test::FlatScene pinhole;
  StereoRig rig;
};

TEST_P(ThroughALens, targets_towards_the_corners_are_found_where_they_are) {
  StereoRig straight = rig;
  for (Intrinsics* camera : {&straight.left, &straight.right})
    camera->distortion = Distortion::kNone;
  const vision::PatchModel photographed = model();
  int misled = 0;
  const Pose truths[] = {test::pose_at(-0.1, -0.12, 0.6, 10, -15, 10),
                         test::pose_at(0.22, 0.13, 0.62, -12, 14, -20),
                         test::pose_at(0.2, -0.1, 0.5, 0, 20, 5)};
  for (const Pose& truth : truths) {
    const test::Picture left = see(true, &truth), right = see(false, &truth);
    const track::Recognition got = find(rig, photographed, left, right);
    ASSERT_TRUE(got.found) << truth.translation.transpose();
    const Eigen::Vector3d error = got.left_from_target.translation - truth.translation;
    const double turned = got.left_from_target.rotation.angularDistance(truth.rotation);
    std::printf("%s: errors %.2f %.2f %.2f mm, %.2f deg\n", GetParam().name, 1e3 * error.x(),
                1e3 * error.y(), 1e3 * error.z(), 57.29578 * turned);
    EXPECT_LT(error.head<2>().norm(), 0.002);
    EXPECT_LT(std::abs(error.z()), 0.004);
    EXPECT_LT(turned, 0.035);
    // That the lens mattered: without it the same pictures mislead by centimetres.
    const track::Recognition wrong = find(straight, photographed, left, right);
    misled +=
        !wrong.found || (wrong.left_from_target.translation - truth.translation).norm() > 0.01;
  }
  EXPECT_EQ(misled, 3);
}

INSTANTIATE_TEST_SUITE_P(
    Lenses, ThroughALens,
    testing::Values(Lens{"brown", Distortion::kBrown, {-0.28, 0.09, 0.0008, -0.0005, -0.01}, 240},
                    Lens{"fisheye", Distortion::kFisheye, {0.05, -0.01, 0.003, -0.001, 0}, 260}),
    [](const auto& lens) { return std::string(lens.param.name); });

}  // namespace
}  // namespace gannet
