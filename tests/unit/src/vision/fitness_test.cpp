// The fitnesses against their double-precision reference, and their peaks at the true pose.
#include "src/vision/fitness.hpp"

#include <gtest/gtest.h>

#include "src/vision/correlation_fitness.hpp"
#include "src/vision/fitness_kinds.hpp"
#include "src/vision/kernel_choice.hpp"
#include "src/vision/projection_fitness.hpp"
#include "src/vision/reference.hpp"
#include "tests/support/flat_scene.hpp"

namespace gannet::vision {
namespace {

using test::pose_at;

StereoRig with_lens(StereoRig rig, Distortion kind) {
  for (Intrinsics* camera : {&rig.left, &rig.right}) {
    camera->distortion = kind;
    if (kind == Distortion::kBrown) camera->coefficients = {-0.28, 0.09, 1e-3, -8e-4, -0.01};
    if (kind == Distortion::kFisheye) camera->coefficients = {-0.02, 0.01, -0.004, 0.001};
  }
  return rig;
}

class Lens : public testing::TestWithParam<Distortion> {};

TEST_P(Lens, float_kernels_sample_the_reference_pixel_for_999_points_of_1000) {
  const StereoRig rig = with_lens(test::FlatScene().rig, GetParam());
  const CameraModel left(rig.left, nullptr);
  const CameraModel right(rig.right, &rig.right_from_left);
  Random random(5);
  std::vector<float> x(1600), y(1600);
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = 0.16f * (random.uniform_f() - 0.5f);
    y[i] = 0.11f * (random.uniform_f() - 0.5f);
  }
  int same = 0;
  int all = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const auto pose = pose_at(0.3 * random.uniform() - 0.1, 0.3 * random.uniform() - 0.15,
                              0.4 + 0.6 * random.uniform(), 60 * random.uniform() - 30,
                              60 * random.uniform() - 30, 80 * random.uniform() - 40);
    const Hypothesis q = Hypothesis::from(pose);
    for (const bool is_left : {true, false}) {
      const CameraModel& camera = is_left ? left : right;
      std::vector<std::int32_t> index(x.size());
      const int guard = 320 * 240;
      camera.project(kScalarKernels, x.data(), y.data(), static_cast<int>(x.size()),
                     camera.view(q, 0.1f, 0, 320, 240, guard), 0, index.data());
      for (std::size_t i = 0; i < x.size(); ++i) {
        const auto pixel = reference::pixel_of(rig, is_left, pose, static_cast<double>(x[i]),
                                               static_cast<double>(y[i]), false);
        same += index[i] == (pixel ? pixel->y() * 320 + pixel->x() : guard);
        ++all;
      }
    }
  }
  EXPECT_GE(same, 0.999 * all) << same << " of " << all;
}

INSTANTIATE_TEST_SUITE_P(All, Lens,
                         testing::Values(Distortion::kNone, Distortion::kBrown,
                                         Distortion::kFisheye));

class OfAScene : public testing::Test {
 protected:
  OfAScene()
      : model(scene.model().value()),
        left(scene.see(true, &truth, 1)),
        right(scene.see(false, &truth, 2)),
        frame(320, 240, {.packed = true, .hue_value = true}) {
    frame.prepare(left.view(), right.view());
    target.background_hue = model.background_hue;
    target.level[0].assign(model.points, model.background, model.background_hue, false);
  }

  TargetPoints rectangle_target() {
    TargetPoints out;
    out.unscaled = true;
    out.background_hue = model.background_hue;
    std::vector<ModelPoint> points;
    const EyePlanes& eye = frame.left();
    const auto centre = scene.rig.left.project(truth.translation).value();
    for (int v = -24; v <= 24; v += 2) {
      for (int u = -34; u <= 34; u += 2) {
        const int x = static_cast<int>(centre.x()) + u;
        const int y = static_cast<int>(centre.y()) + v;
        const Eigen::Vector3d ray = scene.rig.left.ray({x, y});
        const auto at = static_cast<std::size_t>(y * eye.width + x);
        points.push_back(
            {static_cast<float>(ray.x()),
             static_cast<float>(ray.y()),
             std::abs(u) <= 28 && std::abs(v) <= 18,
             {static_cast<float>(eye.smooth[0][at]), static_cast<float>(eye.smooth[1][at]),
              static_cast<float>(eye.smooth[2][at])}});
      }
    }
    out.level[0].assign(points, model.background, model.background_hue, true);
    return out;
  }

  float score(const Fitness& fitness, const TargetPoints& points,
              const Transform<LeftCamera, Target>& pose) {
    const Hypothesis q = Hypothesis::from(pose);
    float out = 0;
    fitness.score(points, frame, 0, {&q, 1}, {&out, 1}, scratch);
    return out;
  }

  std::vector<Transform<LeftCamera, Target>> poses_about(int n) const {
    std::vector<Transform<LeftCamera, Target>> out = {truth};
    Random random(3);
    const auto either = [&](double scale) { return scale * (2 * random.uniform() - 1); };
    for (int i = 1; i < n; ++i) {
      auto pose =
          pose_at(either(0.2), either(0.15), 0.6 + either(0.2), either(30), either(30), either(40));
      out.push_back(pose);
    }
    return out;
  }

  test::FlatScene scene;
  Transform<LeftCamera, Target> truth = pose_at(0.05, -0.02, 0.6, 10, -15, 12);
  PatchModel model;
  test::Picture left, right;
  PreparedFrame frame;
  TargetPoints target;
  Scratch scratch{4096};
};

TEST_F(OfAScene, votes_equal_the_reference_up_to_single_points) {
  for (const VoteRule rule : {VoteRule::kP001, VoteRule::kP002}) {
    const PhotoModelFitness sut(scene.rig, *find_kernels("auto"), rule);
    for (const auto& pose : poses_about(60)) {
      const double expected = reference::photo_model(scene.rig, target, frame, pose, rule);
      EXPECT_NEAR(score(sut, target, pose), expected, 4 * 3.0 / (2 * target.level[0].points()));
    }
  }
}

TEST_F(OfAScene, projection_votes_equal_the_reference_up_to_single_points) {
  const TargetPoints points = rectangle_target();
  const ProjectionFitness sut(scene.rig, *find_kernels("auto"));
  for (const auto& pose : poses_about(60)) {
    const double expected = reference::projection(scene.rig, points, frame, pose);
    EXPECT_NEAR(score(sut, points, pose), expected, 0.02);
  }
}

TEST_F(OfAScene, correlation_equals_the_reference_up_to_seven_bits) {
  const CorrelationOptions options;
  const CorrelationFitness sut(scene.rig, *find_kernels("auto"), options);
  for (const auto& pose : poses_about(60)) {
    const double expected = reference::correlation(scene.rig, target, frame, pose, options);
    EXPECT_NEAR(score(sut, target, pose), expected, 0.02);
  }
}

TEST_F(OfAScene, every_fitness_peaks_at_the_true_pose) {
  for (const char* name : {"p001", "p002", "gannet"}) {
    const auto sut = make_fitness(name, false, scene.rig, *find_kernels("auto"));
    const float at_truth = score(**sut, target, truth);
    for (const auto& pose : poses_about(300)) {
      if ((pose.translation - truth.translation).norm() < 0.03) continue;
      EXPECT_LT(score(**sut, target, pose), at_truth) << name;
    }
  }
}

TEST_F(OfAScene, projection_peaks_at_the_true_depth) {
  const TargetPoints points = rectangle_target();
  for (const char* name : {"p000", "gannet"}) {
    const auto sut = make_fitness(name, true, scene.rig, *find_kernels("auto"));
    const float at_truth = score(**sut, points, truth);
    for (const double factor : {0.7, 0.85, 0.93, 1.08, 1.2, 1.5}) {
      auto pose = truth;
      pose.translation *= factor;
      EXPECT_LT(score(**sut, points, pose), at_truth) << name << " at " << factor;
    }
  }
}

TEST_F(OfAScene, correlation_does_not_see_gain_and_offset) {
  // Half as bright, three quarters of the chroma, as dark and backscatter make it.
  const auto duller = [](test::Picture p) {
    for (auto& y : p.y) y = static_cast<std::uint8_t>(std::lround(0.5 * y + 40));
    for (auto& u : p.u) u = static_cast<std::uint8_t>(std::lround(0.75 * (u - 128) + 120));
    for (auto& v : p.v) v = static_cast<std::uint8_t>(std::lround(0.75 * (v - 128) + 138));
    return p;
  };
  const CorrelationFitness sut(scene.rig, *find_kernels("auto"));
  const float before = score(sut, target, truth);
  const test::Picture dull_left = duller(left);
  const test::Picture dull_right = duller(right);
  frame.prepare(dull_left.view(), dull_right.view());
  EXPECT_NEAR(score(sut, target, truth), before, 0.03);
}

TEST(Votes, have_the_factors_of_the_papers) {
  const VoteCounts counts = {10, 4, 3, 2, 7, 5};
  EXPECT_NEAR(photo_model_votes(VoteRule::kP002, counts), 20 - 0.025 + 0.7 - 2.5, 1e-12);
  EXPECT_NEAR(photo_model_votes(VoteRule::kP001, counts), 20 - 4 - 0.015 + 0.7 - 2.5, 1e-12);
}

TEST(ProjectionVotes, join_hue_and_value_as_probabilities_do) {
  // All match: F_H = F_B = 1 and F = 1. Nothing matches: both are cut at 0.
  EXPECT_NEAR(projection_votes({30, 0, 30, 0}, {20, 0, 20, 0}, 30, 20), 1, 1e-12);
  EXPECT_NEAR(projection_votes({0, 30, 0, 30}, {0, 20, 0, 20}, 30, 20), 0, 1e-12);
  EXPECT_NEAR(projection_votes({30, 0, 0, 30}, {20, 0, 0, 20}, 30, 20), 1, 1e-12);
}

TEST(Kinds, refuse_what_cannot_score_the_target) {
  const StereoRig rig = test::FlatScene().rig;
  EXPECT_FALSE(make_fitness("p000", false, rig, kScalarKernels));
  EXPECT_FALSE(make_fitness("p002", true, rig, kScalarKernels));
  const auto unknown = make_fitness("p003", false, rig, kScalarKernels);
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().text.find("gannet"), std::string::npos);
}

}  // namespace
}  // namespace gannet::vision
