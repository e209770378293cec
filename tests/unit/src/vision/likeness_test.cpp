#include "src/vision/likeness.hpp"

#include <gtest/gtest.h>

#include "tests/support/flat_scene.hpp"

namespace gannet::vision {
namespace {

using test::pose_at;
using Pose = Transform<LeftCamera, Target>;

constexpr double kFound = 0.5;  // what the tracker asks for, its lead left out

// What murky water does: less contrast about a veil.
test::Picture veiled(test::Picture picture, double gain, double veil) {
  for (auto* plane : {&picture.y, &picture.u, &picture.v}) {
    for (std::uint8_t& value : *plane)
      value = static_cast<std::uint8_t>(std::lround(veil + gain * (value - 128.0)));
  }
  return picture;
}

struct Likeness : testing::Test {
  test::FlatScene scene;
  PatchModel model;
  PointSet points;
  PreparedFrame frame = {320, 240, {.packed = true}};
  const Pose truth = pose_at(0.05, -0.01, 0.6, 8, -12, 10);

  void learn() {
    model = scene.model(900).value();
    points.assign(model.points, model.background, model.background_hue, false);
  }
  void see(double gain, double veil, bool in_left = true, bool in_right = true) {
    const test::Picture left = veiled(scene.see(true, in_left ? &truth : nullptr, 5), gain, veil);
    const test::Picture right =
        veiled(scene.see(false, in_right ? &truth : nullptr, 6), gain, veil);
    frame.prepare(left.view(), right.view());
  }
  double at(const Pose& pose) const { return likeness(scene.rig, points, frame, pose); }
};

TEST_F(Likeness, is_high_at_the_target_and_low_elsewhere) {
  learn();
  see(1, 128);
  const double own = at(truth);
  EXPECT_GT(own, 2 * kFound);
  Random random(3);
  const auto either = [&](double scale) { return scale * (2 * random.uniform() - 1); };
  double most = 0;
  for (int i = 0; i < 500; ++i) {
    Pose wrong = pose_at(either(0.2), either(0.15), 0.6 + either(0.15), either(35), either(35), 0);
    if ((wrong.translation - truth.translation).norm() < 0.06) continue;
    most = std::max(most, at(wrong));
  }
  EXPECT_LT(most, 0.7 * kFound);
  EXPECT_GT(most, 0);
}

// The correlation of the search is eaten by its floors there.
TEST_F(Likeness, does_not_fade_with_contrast) {
  scene.noise = 0.4;
  learn();
  see(1, 128);
  const double clear = at(truth);
  see(0.4, 90);
  EXPECT_NEAR(at(truth), clear, 0.2 * clear);
  see(0.08, 60);  // the target's texture is some two grey levels
  EXPECT_GT(at(truth), kFound);
}

TEST_F(Likeness, needs_both_eyes) {
  learn();
  see(1, 128, true, false);
  EXPECT_LT(at(truth), 0.7 * kFound);
  see(1, 128, false, true);
  EXPECT_LT(at(truth), 0.7 * kFound);
}

TEST_F(Likeness, is_nothing_where_less_than_half_is_in_view) {
  learn();
  see(1, 128);
  const double edge = 0.6 * 160 / 320;  // of the left image, at the target's depth
  EXPECT_EQ(at(pose_at(-edge - 0.02, 0, 0.6, 0, 0, 0)), 0);
  EXPECT_EQ(at(pose_at(0, 0, -0.6, 0, 0, 0)), 0) << "behind the cameras";
}

TEST_F(Likeness, knows_a_plain_target_by_what_is_around_it) {
  scene.target = test::Texture(11, 0.05, 0);
  learn();
  see(1, 128);
  EXPECT_GT(at(truth), kFound);
  EXPECT_LT(at(pose_at(-0.08, 0.05, 0.7, 0, 0, 0)), 0.7 * kFound);
}

}  // namespace
}  // namespace gannet::vision
