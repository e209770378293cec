// Recognition through the flat port of a housing, which bends light: pictures are traced by Snell's
// law face by face (tests/support/flat_scene.hpp). The photo of the target is taken through the
// port too. With the port in the rig poses are right within a millimetre from near to far; with the
// port folded into lens and focal length, as a calibration in water does it, near what it was
// calibrated for alone.
#include <gtest/gtest.h>

#include <cmath>

#include "src/track/recogniser.hpp"
#include "tests/support/flat_scene.hpp"
#include "tests/support/folded_port.hpp"
#include "tests/support/heap_calls.hpp"

namespace gannet {
namespace {

using Pose = Transform<LeftCamera, Target>;

struct Housing {
  const char* name;
  double distance_m, thickness_m;
  Eigen::Vector3d left_normal, right_normal;
  Distortion lens;
};

class ThroughAPort : public testing::TestWithParam<Housing> {
 protected:
  void SetUp() override {
    if (!test::kCountsHeap) GTEST_SKIP() << "too slow under a sanitizer";
  }

  ThroughAPort() {
    const Housing& housing = GetParam();
    for (Intrinsics* camera : {&scene.rig.left, &scene.rig.right}) {
      camera->width = 640;
      camera->height = 480;
      camera->fx = camera->fy = 480;
      camera->cx = 319.5;
      camera->cy = 239.5;
      camera->distortion = housing.lens;
      if (housing.lens == Distortion::kBrown)
        camera->coefficients = {-0.2, 0.05, 0.0008, -0.0005, -0.01};
      camera->port = FlatPort{};
      camera->port->distance_m = housing.distance_m;
      camera->port->thickness_m = housing.thickness_m;
    }
    scene.rig.left.port->normal = housing.left_normal.normalized();
    scene.rig.right.port->normal = housing.right_normal.normalized();
    scene.ground_z = 2;
    scene.noise = 0.5;
  }

  static track::Recognition find(const StereoRig& believed, const vision::PatchModel& model,
                                 const test::Picture& left, const test::Picture& right) {
    track::TrackConfig config;
    config.z_max_m = 1.6;
    auto sut = track::Recogniser::create(config, believed, track::TargetKind::kModel).value();
    vision::PreparedFrame frame(left.width, left.height, sut->needs());
    EXPECT_TRUE(frame.prepare(left.view(), right.view()));
    EXPECT_TRUE(sut->set_model(model));
    Serial serial;
    return sut->recognise(frame, nullptr, {}, serial);
  }

  test::FlatScene scene;
};

TEST_P(ThroughAPort, targets_near_and_far_are_found_where_they_are) {
  const vision::PatchModel photographed = scene.model(800).value();
  // As large as a photo in air shows it, to two of its pixels: silhouettes are as rough.
  test::FlatScene in_air = scene;
  in_air.rig.left.port.reset();
  in_air.rig.left.fx = in_air.rig.left.fy = scene.rig.left.magnification().x();
  in_air.rig.left.distortion = Distortion::kNone;
  const vision::PatchModel plain = in_air.model(800).value();
  const double two_px = 2 * 0.4 / in_air.rig.left.fx;
  EXPECT_NEAR(photographed.size_m.x(), plain.size_m.x(), two_px);
  EXPECT_NEAR(photographed.size_m.y(), plain.size_m.y(), two_px);
  const Pose truths[] = {
      test::pose_at(0.05, 0.02, 0.4, 5, -10, 12), test::pose_at(0.18, 0.1, 0.6, -12, 14, -20),
      test::pose_at(-0.1, -0.16, 0.8, 10, 15, 10), test::pose_at(0.3, -0.2, 1.1, 0, 20, 5),
      test::pose_at(0.1, 0.2, 1.5, 15, -10, 30)};
  const test::FoldedPort folded = test::fold_ports(scene.rig, 0.7, 0.9);
  double worst = 0, worst_folded = 0;
  for (const Pose& truth : truths) {
    const test::Picture left = scene.see(true, &truth, 11), right = scene.see(false, &truth, 12);
    const track::Recognition got = find(scene.rig, photographed, left, right);
    ASSERT_TRUE(got.found) << truth.translation.transpose();
    const Eigen::Vector3d error = got.left_from_target.translation - truth.translation;
    const track::Recognition wrong = find(folded.rig, photographed, left, right);
    const Eigen::Vector3d misled =
        wrong.left_from_target.translation + folded.left_from_rig - truth.translation;
    worst = std::max(worst, error.norm());
    if (wrong.found) worst_folded = std::max(worst_folded, misled.norm());
    std::printf(
        "%s, %.1f m: errors %.2f %.2f %.2f mm, %.2f deg; folded %s %.1f %.1f %.1f mm\n",
        GetParam().name, truth.translation.z(), 1e3 * error.x(), 1e3 * error.y(), 1e3 * error.z(),
        57.29578 * got.left_from_target.rotation.angularDistance(truth.rotation),
        wrong.found ? "found" : "not found", 1e3 * misled.x(), 1e3 * misled.y(), 1e3 * misled.z());
    EXPECT_LT(error.norm(), 0.001);
    EXPECT_LT(got.left_from_target.rotation.angularDistance(truth.rotation), 0.02);
  }
  EXPECT_GT(worst_folded, 2 * worst) << "the fit is off by " << folded.worst_px << " px at most";
}

TEST_P(ThroughAPort, the_plane_behind_a_rectangle_is_found_where_it_is) {
  const Pose truths[] = {test::pose_at(0.05, 0.02, 0.45, 5, -10, 12),
                         test::pose_at(0.2, 0.12, 0.7, -12, 14, -20),
                         test::pose_at(0.0, -0.15, 0.9, 10, 5, 10)};
  for (const Pose& truth : truths) {
    const test::Picture left = scene.see(true, &truth, 21), right = scene.see(false, &truth, 22);
    auto sut = track::Recogniser::create({}, scene.rig, track::TargetKind::kRectangle).value();
    vision::PreparedFrame frame(640, 480, sut->needs());
    ASSERT_TRUE(frame.prepare(left.view(), right.view()));
    const Eigen::Vector2d at = *scene.rig.left.project(truth.translation);
    const double pixels = 640 / truth.translation.z();
    const int width = static_cast<int>(0.1 * pixels), height = static_cast<int>(0.07 * pixels);
    const vision::Rectangle r = {static_cast<int>(at.x()) - width / 2,
                                 static_cast<int>(at.y()) - height / 2, width, height};
    ASSERT_TRUE(sut->set_rectangle(r, frame));
    Serial serial;
    const track::Recognition got = sut->recognise(frame, nullptr, {}, serial);
    ASSERT_TRUE(got.found);
    const Line sight = *scene.rig.left.line({r.x + (width - 1) / 2.0, r.y + (height - 1) / 2.0});
    const Eigen::Vector3d n = truth.rotation * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d expected = sight.at_plane(n, n.dot(truth.translation));
    const Eigen::Vector3d error = got.left_from_target.translation - expected;
    const double turned =
        std::acos(std::min(1.0, n.dot(got.left_from_target.rotation * Eigen::Vector3d::UnitZ())));
    std::printf("%s, rectangle at %.2f m: errors %.2f %.2f %.2f mm, %.2f deg\n", GetParam().name,
                truth.translation.z(), 1e3 * error.x(), 1e3 * error.y(), 1e3 * error.z(),
                57.29578 * turned);
    EXPECT_LT(error.norm(), 0.002 * truth.translation.z());
    EXPECT_LT(turned, 0.05);
    // As a model it is on the same plane, in metres.
    vision::PatchModel model;
    ASSERT_TRUE(sut->to_model(got.left_from_target, model));
    for (const vision::ModelPoint& p : model.points) {
      const Eigen::Vector3d point =
          got.left_from_target({static_cast<double>(p.x_m), static_cast<double>(p.y_m), 0});
      const auto pixel = scene.rig.left.project(point);
      ASSERT_TRUE(pixel);
      EXPECT_LT((*pixel - pixel->array().round().matrix()).norm(), 0.02);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Housings, ThroughAPort,
    testing::Values(
        Housing{"usual", 0.03, 0.01, {0, 0, 1}, {0, 0, 1}, Distortion::kNone},
        Housing{"deep", 0.09, 0.02, {0.03, -0.05, 1}, {-0.04, -0.05, 1}, Distortion::kNone},
        Housing{"brown", 0.05, 0.01, {0.02, 0.01, 1}, {0.01, -0.03, 1}, Distortion::kBrown}),
    [](const auto& housing) { return std::string(housing.param.name); });

}  // namespace
}  // namespace gannet
