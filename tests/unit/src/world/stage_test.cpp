#include "src/world/stage.hpp"

#include <gtest/gtest.h>

namespace gannet::world {
namespace {

Scenario two_targets() {
  Scenario s;
  s.targets.resize(2);
  s.targets[0].name = "crab";
  s.targets[0].position_mm = {50, -20, 600};
  s.targets[0].motion.kind = "sine";
  s.targets[0].motion.amplitude_mm = {0, 0, 30};
  s.targets[0].motion.period_s = {4, 4, 4};
  s.targets[0].motion.phase_deg = {0, 0, 0};
  s.targets[1].name = "star";
  s.targets[1].size_mm = {73, 73};
  return s;
}

TEST(Stage, targets_stand_and_move_in_the_hand_frame) {
  const Scenario s = two_targets();
  const Stage sut(s, {{3, 4}, 0, 1}, 1);
  const int crab = sut.find("crab");
  const auto hand_from_target = s.world_from_reference().inverse() * sut.pose(crab, 1);
  EXPECT_LT((hand_from_target.translation - Eigen::Vector3d(0.05, -0.02, 0.63)).norm(), 1e-12);
  EXPECT_NEAR(hand_from_target.rotation.angularDistance(Eigen::Quaterniond::Identity()), 0, 1e-9);
  EXPECT_EQ(sut.find("whale"), -1);
}

TEST(Stage, the_scene_shows_what_there_is) {
  Scenario s = two_targets();
  s.scene.water = "coastal";
  s.scene.snow = 7;
  Stage sut(s, {{3, 4}, 5, 6}, 1);
  sut.set_light(5);
  const Scene plain = sut.scene(0);
  ASSERT_EQ(plain.objects.size(), 2u);
  EXPECT_EQ(plain.objects[1].texture, 4);
  EXPECT_EQ(plain.objects[1].size_m, Eigen::Vector2d(0.073, 0.073));
  EXPECT_EQ(plain.background.at(0).texture, 5);
  EXPECT_EQ(plain.light.lux, 5);
  EXPECT_EQ(plain.particles.count, 7);
  EXPECT_GT(plain.water.attenuation_per_m[0], 0.5);
}

TEST(Stage, a_cover_stands_before_its_target_and_is_larger) {
  const Scenario s = two_targets();
  Stage sut(s, {{3, 4}, 5, 6}, 1);
  sut.cover(0, true);
  const Scene scene = sut.scene(2);
  ASSERT_EQ(scene.objects.size(), 3u);
  const auto hand_from_cover = s.world_from_reference().inverse() * scene.objects[1].pose;
  EXPECT_EQ(scene.objects[1].texture, 6);
  EXPECT_LT(hand_from_cover.translation.z(), 0.6);
  EXPECT_GT(scene.objects[1].size_m.x(), scene.objects[0].size_m.x());
  sut.cover(0, false);
  EXPECT_EQ(sut.scene(2).objects.size(), 2u);
}

TEST(Stage, knows_what_is_in_view) {
  const Scenario s = two_targets();
  const Stage sut(s, {{3, 4}, 0, 1}, 1);
  Transform<World, Hand> hand = s.world_from_reference();
  EXPECT_TRUE(sut.in_view(0, 0, s.rig(), hand));
  hand.translation += hand.rotation * Eigen::Vector3d(0.3, 0, 0);  // to the right of it
  EXPECT_FALSE(sut.in_view(0, 0, s.rig(), hand));
  hand = s.world_from_reference();
  hand.translation += hand.rotation * Eigen::Vector3d(0, 0, 2);  // past it
  EXPECT_FALSE(sut.in_view(0, 0, s.rig(), hand));
}

}  // namespace
}  // namespace gannet::world
