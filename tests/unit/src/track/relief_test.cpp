#include "src/track/relief.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "tests/support/flat_scene.hpp"
#include "tests/support/heap_calls.hpp"

namespace gannet::track {
namespace {

using Pose = Transform<LeftCamera, Target>;
using vision::Refinement;

class TrackedRelief : public testing::TestWithParam<double> {
 protected:
  TrackedRelief() {
    scene.bulge_m = GetParam();
    model = scene.model(500).value();
    points.reserve(2000);
    points.assign(model.points, model.background, model.background_hue, false);
    sut.reset(points, model.spacing_m, model.eye_m);
    Random random(6);
    const auto either = [&](double scale) { return scale * (2 * random.uniform() - 1); };
    for (std::uint64_t k = 0; k < 8; ++k) {
      poses.push_back(test::pose_at(0.06 + either(0.05), either(0.04), 0.5 + either(0.06),
                                    either(15), either(15), either(20)));
      const test::Picture left = scene.see(true, &poses.back(), 10 + 2 * k);
      const test::Picture right = scene.see(false, &poses.back(), 11 + 2 * k);
      frames.push_back(
          std::make_unique<vision::PreparedFrame>(320, 240, vision::PlaneNeeds{.packed = true}));
      EXPECT_TRUE(frames.back()->prepare(left.view(), right.view()));
    }
  }

  struct Errors {
    double flat_rad = 0, rad = 0;  // summed over one round of the views
    double largest_step_m = 0;     // by which the answer leaves the flat one within one frame
    int differing = 0;             // answers
  };
  Errors run(int rounds, bool locked) {
    Errors out;
    std::vector<double> apart(frames.size(), 0);
    for (int round = 0; round < rounds; ++round) {
      out.flat_rad = out.rad = 0;
      for (std::size_t k = 0; k < frames.size(); ++k) {
        const Refinement flat = vision::refine_pose(optics, points, *frames[k], poses[k], {});
        const std::uint64_t before = test::heap_calls;
        const Refinement got = sut.refine(optics, points, *frames[k], flat, {}, locked);
        EXPECT_EQ(test::heap_calls, before);
        out.flat_rad += flat.left_from_target.rotation.angularDistance(poses[k].rotation);
        out.rad += got.left_from_target.rotation.angularDistance(poses[k].rotation);
        const double here =
            (got.left_from_target.translation - flat.left_from_target.translation).norm();
        out.largest_step_m = std::max(
            out.largest_step_m, std::abs(here - apart[k]) / static_cast<double>(frames.size()));
        out.differing += here > 0;
        apart[k] = here;
      }
    }
    return out;
  }

  test::FlatScene scene;
  vision::PatchModel model;
  vision::PointSet points;
  vision::RigOptics optics{scene.rig};
  Relief sut{2000};
  std::vector<Pose> poses;
  std::vector<std::unique_ptr<vision::PreparedFrame>> frames;
};

class TrackedDome : public TrackedRelief {};
class TrackedPlane : public TrackedRelief {};

TEST_P(TrackedDome, is_learned_and_halves_the_angles_errors) {
  const Errors got = run(45, true);
  EXPECT_TRUE(sut.in_use());
  EXPECT_LT(got.rad, 0.5 * got.flat_rad) << got.rad / 8 << " of " << got.flat_rad / 8 << " rad";
  EXPECT_LT(got.largest_step_m, 0.001);
}

TEST_P(TrackedDome, is_not_learned_from_what_is_not_locked) {
  const Errors got = run(20, false);
  EXPECT_FALSE(sut.in_use());
  EXPECT_EQ(got.differing, 0);
}

TEST_P(TrackedDome, is_forgotten_with_its_target) {
  run(20, true);
  ASSERT_TRUE(sut.in_use());
  sut.reset(points, model.spacing_m, model.eye_m);
  EXPECT_EQ(run(1, false).differing, 0);
}

TEST_P(TrackedPlane, stays_flat) {
  const Errors got = run(45, true);
  EXPECT_FALSE(sut.in_use());
  EXPECT_EQ(got.differing, 0);
}

INSTANTIATE_TEST_SUITE_P(Round, TrackedDome, testing::Values(0.012));
INSTANTIATE_TEST_SUITE_P(Flat, TrackedPlane, testing::Values(0.0));

}  // namespace
}  // namespace gannet::track
