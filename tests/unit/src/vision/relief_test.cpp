#include "src/vision/relief.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/support/flat_scene.hpp"

namespace gannet::vision {
namespace {

using Pose = Transform<LeftCamera, Target>;

// Some views of a dome (or of none), and what stereo makes of them with the truth as pose.
class ReliefOf : public testing::TestWithParam<double> {
 protected:
  ReliefOf() {
    scene.bulge_m = GetParam();
    model = scene.model(500).value();
    flat.reserve(2000), solid.reserve(2000);
    flat.assign(model.points, model.background, model.background_hue, false);
    Random random(5);
    const auto either = [&](double scale) { return scale * (2 * random.uniform() - 1); };
    for (std::uint64_t k = 0; k < 6; ++k) {
      poses.push_back(test::pose_at(0.06 + either(0.05), either(0.04), 0.5 + either(0.06),
                                    either(15), either(15), either(20)));
      const test::Picture left = scene.see(true, &poses.back(), 10 + 2 * k);
      const test::Picture right = scene.see(false, &poses.back(), 11 + 2 * k);
      frames.push_back(std::make_unique<PreparedFrame>(320, 240, PlaneNeeds{.packed = true}));
      EXPECT_TRUE(frames.back()->prepare(left.view(), right.view()));
    }
  }
  void learn() {
    ReliefEstimator sut(2000);
    sut.reset(flat, model.spacing_m, model.eye_m);
    for (std::size_t i = 0; !sut.complete() && i < 1000; ++i) {
      const std::size_t k = i % frames.size();
      Refinement seen = refine_pose(scene.rig, flat, *frames[k], poses[k], {});
      seen.left_from_target = poses[k];
      sut.see(scene.rig, flat, *frames[k], seen);
    }
    ASSERT_TRUE(sut.complete());
    sut.lay(flat, solid);
  }
  // Over all views.
  double mean_angle(const PointSet& points) const {
    double sum = 0;
    for (std::size_t k = 0; k < frames.size(); ++k) {
      const Refinement got = refine_pose(scene.rig, points, *frames[k], poses[k], {});
      EXPECT_TRUE(got.ok);
      sum += got.left_from_target.rotation.angularDistance(poses[k].rotation);
    }
    return sum / static_cast<double>(frames.size());
  }

  test::FlatScene scene;
  PatchModel model;
  PointSet flat, solid;
  std::vector<Pose> poses;
  std::vector<std::unique_ptr<PreparedFrame>> frames;
};

TEST_P(ReliefOf, is_where_the_surface_is) {
  learn();
  double squares = 0;
  for (int i = 0; i < solid.inside; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double apart =
        static_cast<double>(solid.z[k]) -
        scene.dome(static_cast<double>(solid.x[k]), static_cast<double>(solid.y[k]));
    squares += apart * apart;
  }
  EXPECT_LT(std::sqrt(squares / solid.inside), 0.002);
  for (std::size_t k = static_cast<std::size_t>(solid.inside_padded); k < solid.x.size(); ++k) {
    EXPECT_EQ(solid.z[k], 0);
  }
}

TEST_P(ReliefOf, makes_the_refinement_right_where_the_flat_model_is_not) {
  learn();
  const double flat_angle = mean_angle(flat), solid_angle = mean_angle(solid);
  EXPECT_LT(solid_angle, 0.02);
  if (GetParam() > 0) {
    EXPECT_GT(flat_angle, 2 * solid_angle) << solid_angle;
  }
}

INSTANTIATE_TEST_SUITE_P(Domes, ReliefOf, testing::Values(0, 0.012),
                         [](const auto& tested) { return tested.param > 0 ? "Dome" : "Plane"; });

}  // namespace
}  // namespace gannet::vision
