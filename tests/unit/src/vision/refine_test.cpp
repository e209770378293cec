#include "src/vision/refine.hpp"

#include <gtest/gtest.h>

#include "tests/support/flat_scene.hpp"

namespace gannet::vision {
namespace {

using test::pose_at;

class Refine : public testing::Test {
 protected:
  Refine() : model(scene.model(900).value()), frame(320, 240, {.packed = true}) {
    points.assign(model.points, model.background, model.background_hue, false);
  }
  void see(const Transform<LeftCamera, Target>& pose, std::uint64_t seed) {
    const test::Picture left = scene.see(true, &pose, seed);
    const test::Picture right = scene.see(false, &pose, seed + 1);
    frame.prepare(left.view(), right.view());
  }
  test::FlatScene scene;
  PatchModel model;
  PointSet points;
  PreparedFrame frame;
};

TEST_F(Refine, pulls_a_pose_from_a_few_millimetres_to_a_tenth_of_one) {
  Random random(4);
  const auto either = [&](double scale) { return scale * (2 * random.uniform() - 1); };
  double worst_xy = 0, worst_z = 0, worst_angle = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const auto truth = pose_at(0.06 + either(0.08), either(0.06), 0.55 + either(0.12), either(20),
                               either(20), either(30));
    see(truth, 10 + 2 * static_cast<std::uint64_t>(trial));
    auto start = truth;
    start.translation += Eigen::Vector3d(either(0.003), either(0.003), either(0.01));
    start.rotation = quaternion_from_rpy(either(0.05), either(0.05), either(0.03)) * start.rotation;
    const Refinement got = refine_pose(scene.rig, points, frame, start, {});
    ASSERT_TRUE(got.ok);
    const Eigen::Vector3d error = got.left_from_target.translation - truth.translation;
    worst_xy = std::max(worst_xy, error.head<2>().norm());
    worst_z = std::max(worst_z, std::abs(error.z()));
    worst_angle =
        std::max(worst_angle, got.left_from_target.rotation.angularDistance(truth.rotation));
  }
  EXPECT_LT(worst_xy, 0.0006);
  EXPECT_LT(worst_z, 0.002);
  EXPECT_LT(worst_angle, 0.025);
}

TEST_F(Refine, states_a_covariance_of_the_size_of_its_errors) {
  const auto truth = pose_at(0.05, -0.01, 0.6, 8, -12, 10);
  double squares = 0;
  constexpr int kTrials = 20;
  for (int trial = 0; trial < kTrials; ++trial) {
    see(truth, 100 + 2 * static_cast<std::uint64_t>(trial));
    const Refinement got = refine_pose(scene.rig, points, frame, truth, {});
    ASSERT_TRUE(got.ok);
    Vector6d error;
    error << got.left_from_target.translation - truth.translation,
        rotation_vector_from_quaternion(got.left_from_target.rotation * truth.rotation.conjugate());
    squares += error.dot(got.covariance.inverse() * error) / 6;
  }
  // 1 would be exact; what the photo's own noise adds is the same in all trials.
  EXPECT_GT(squares / kTrials, 0.1);
  EXPECT_LT(squares / kTrials, 4) << squares / kTrials;
}

TEST_F(Refine, finds_the_plane_of_a_rectangle) {
  const auto truth = pose_at(0.05, -0.01, 0.6, 12, -18, 0);
  see(truth, 7);
  const auto centre = scene.rig.left.project(truth.translation).value();
  std::vector<ModelPoint> patch;
  const EyePlanes& eye = frame.left();
  for (int v = -16; v <= 16; ++v) {
    for (int u = -24; u <= 24; ++u) {
      const int x = static_cast<int>(centre.x()) + u, y = static_cast<int>(centre.y()) + v;
      const Eigen::Vector3d ray = scene.rig.left.ray({x, y});
      const auto at = static_cast<std::size_t>(y * eye.width + x);
      patch.push_back(
          {static_cast<float>(ray.x()),
           static_cast<float>(ray.y()),
           true,
           {static_cast<float>(eye.smooth[0][at]), static_cast<float>(eye.smooth[1][at]),
            static_cast<float>(eye.smooth[2][at])}});
    }
  }
  PointSet set;
  set.assign(patch, {}, 0, true);
  const Eigen::Vector3d ray = scene.rig.left.ray({std::floor(centre.x()), std::floor(centre.y())});
  const Eigen::Vector3d normal = truth.rotation * Eigen::Vector3d::UnitZ();
  const auto start = pose_of_plane(Eigen::Vector3d(0, 0, 1 / 0.585), ray);
  const Refinement got = refine_plane(scene.rig, set, frame, start, ray, {});
  ASSERT_TRUE(got.ok);
  const double true_depth = normal.dot(truth.translation) / normal.dot(ray);
  EXPECT_NEAR(got.left_from_target.translation.z(), true_depth, 0.003);
  const Eigen::Vector3d found = got.left_from_target.rotation * Eigen::Vector3d::UnitZ();
  EXPECT_LT(std::acos(std::min(1.0, found.dot(normal))), 0.06);
}

TEST_F(Refine, says_no_where_nothing_is_to_be_seen) {
  const auto away = pose_at(5, 0, 0.6);
  see(pose_at(0, 0, 0.6), 1);
  EXPECT_FALSE(refine_pose(scene.rig, points, frame, away, {}).ok);
}

}  // namespace
}  // namespace gannet::vision
