#include "src/track/target_tracker.hpp"

#include <gtest/gtest.h>

#include "src/track/track_config.hpp"
#include "src/track/track_state.hpp"
#include "tests/support/flat_scene.hpp"
#include "tests/support/heap_calls.hpp"

namespace gannet::track {
namespace {

using std::chrono::milliseconds;
using test::pose_at;

class Tracking : public testing::Test {
 protected:
  Tracking() {
    config.evaluations = 4000;
    config.evaluations_tracking = 800;
    auto made = TargetTracker::create(config, scene.rig, {scene.model(400).value()});
    EXPECT_TRUE(made) << made.error().text;
    sut = std::move(*made);
  }
  PoseEstimate see(const Transform<LeftCamera, Target>* pose) {
    ++number;
    now += milliseconds(33);
    const test::Picture left = scene.see(true, pose, 2 * number);
    const test::Picture right = scene.see(false, pose, 2 * number + 1);
    return sut->process(left.view(), right.view(), now, number, budget, serial);
  }
  test::FlatScene scene;
  TrackConfig config;
  std::unique_ptr<TargetTracker> sut;
  Serial serial;
  Budget budget;
  TimePoint now = time_from_ns(1'000'000'000);
  std::uint64_t number = 0;
};

TEST_F(Tracking, without_a_target_it_answers_no_target) {
  const auto pose = pose_at(0.05, 0, 0.6);
  const PoseEstimate got = see(&pose);
  EXPECT_FALSE(got.found);
  EXPECT_EQ(got.reason, TrackReason::kNoTarget);
  EXPECT_EQ(got.target_id, 0u);
}

TEST_F(Tracking, locks_follows_coasts_loses_and_finds_again) {
  ASSERT_TRUE(sut->choose_model(0, 7));
  auto pose = pose_at(0.05, 0, 0.6, 5, 5, 5);
  EXPECT_EQ(see(&pose).state, TrackState::kSearching);
  for (int i = 0; i < 4; ++i) {
    pose.translation.x() += 0.003;
    const PoseEstimate got = see(&pose);
    EXPECT_EQ(got.state, TrackState::kLocked);
    EXPECT_EQ(got.target_id, 7u);
    EXPECT_LT((got.left_from_target.translation - pose.translation).norm(), 0.005);
    EXPECT_GT(got.covariance(2, 2), 0);
  }
  EXPECT_EQ(see(nullptr).state, TrackState::kCoasting);
  PoseEstimate got;
  for (int i = 0; i < 16; ++i) got = sut->no_frame(now += milliseconds(33));
  EXPECT_EQ(got.state, TrackState::kLost);
  EXPECT_EQ(got.reason, TrackReason::kNoFrames);
  see(&pose);
  EXPECT_EQ(see(&pose).state, TrackState::kLocked);
}

// A newer pair is always there when the computer is slower than the cameras.
TEST_F(Tracking, finds_its_target_however_slow_the_computer) {
  ASSERT_TRUE(sut->choose_model(0, 7));
  budget.stop = [](void*) { return true; };
  const auto pose = pose_at(0.05, 0, 0.6, 5, 5, 5);
  see(&pose);
  EXPECT_EQ(see(&pose).state, TrackState::kLocked);
}

TEST_F(Tracking, a_locked_frame_costs_little_and_measures_as_well) {
  ASSERT_TRUE(sut->choose_model(0, 7));
  auto pose = pose_at(0.05, 0, 0.6, 5, 5, 5);
  see(&pose);
  for (int i = 0; i < 8; ++i) {
    pose.translation += Eigen::Vector3d(0.004, -0.003, 0.005);
    const PoseEstimate got = see(&pose);
    ASSERT_TRUE(got.found);
    if (i > 0) {
      EXPECT_LT(got.evaluations, 100) << i;
    }
    EXPECT_LT((got.left_from_target.translation - pose.translation).norm(), 0.0025) << i;
  }
}

TEST_F(Tracking, what_leaps_away_from_the_prediction_is_found_in_the_same_frame) {
  ASSERT_TRUE(sut->choose_model(0, 7));
  auto pose = pose_at(0.05, 0, 0.6, 5, 5, 5);
  for (int i = 0; i < 3; ++i) see(&pose);
  pose = pose_at(-0.03, 0.06, 0.7, -10, 5, -15);
  const PoseEstimate got = see(&pose);
  EXPECT_TRUE(got.found);
  EXPECT_LT((got.left_from_target.translation - pose.translation).norm(), 0.005);
}

// Each search from nothing may find either of two poses that look alike.
TEST_F(Tracking, a_symmetric_target_does_not_flip) {
  config.roll_deg = 180;
  scene.twofold = true;
  const auto model = scene.model(400).value();
  ASSERT_EQ(model.symmetry.rolls.size(), 1u);
  int turned_over = 0;
  Eigen::Quaterniond last;
  for (int i = 0; i < 10; ++i) {
    // Another seed finds another of the two.
    config.seed = 1 + i;
    auto another = TargetTracker::create(config, scene.rig, {model}).value();
    ASSERT_TRUE(another->choose_model(0, 7));
    std::swap(sut, another);
    const auto pose = pose_at(0.05, 0.01, 0.6, 12, -9, 20 + i);
    ASSERT_TRUE(see(&pose).found);
    const PoseEstimate got = see(&pose);
    ASSERT_TRUE(got.found);
    turned_over += got.left_from_target.rotation.angularDistance(pose.rotation) > 1.5;
  }
  EXPECT_GT(turned_over, 0);  // else there is nothing to see here
  EXPECT_LT(turned_over, 10);

  ASSERT_TRUE(sut->choose_model(0, 7));
  for (int i = 0; i < 60; ++i) {
    const auto pose = pose_at(0.05, 0.01, 0.6, 12, -9, 3 * i);  // slowly half round
    const PoseEstimate got = see(&pose);
    ASSERT_TRUE(got.found) << i;
    if (i > 0) {
      EXPECT_LT(got.left_from_target.rotation.angularDistance(last), 0.1) << i;
    }
    last = got.left_from_target.rotation;
    if (i % 6 != 5) continue;
    for (int k = 0; k < 17; ++k) sut->no_frame(now += milliseconds(33));  // lost: from nothing
  }
}

// A leap to another attitude: tilted the wrong way the model resembles the picture, too.
TEST_F(Tracking, after_a_leap_no_wrong_attitude_is_kept) {
  if (!test::kCountsHeap) GTEST_SKIP() << "too slow under a sanitizer";
  config.evaluations_tracking = 2000;
  sut = TargetTracker::create(config, scene.rig, {scene.model(400).value()}).value();
  Random random(5);
  const auto either = [&](double scale) { return scale * (2 * random.uniform() - 1); };
  constexpr int kTrials = 24;
  int wrong = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    ASSERT_TRUE(sut->choose_model(0, 7));
    const auto attitude = [&] { return std::array{either(35), either(35), either(35)}; };
    auto a = attitude();
    auto pose = pose_at(0.06 + either(0.04), either(0.04), 0.6, a[0], a[1], a[2]);
    for (int i = 0; i < 2; ++i) see(&pose);
    const Eigen::Vector3d leapt =
        pose.translation + Eigen::Vector3d(either(0.05), either(0.05), either(0.08));
    a = attitude();
    pose = pose_at(leapt.x(), leapt.y(), leapt.z(), a[0], a[1], a[2]);
    PoseEstimate got;
    for (int i = 0; i < 6; ++i) got = see(&pose);
    const double turned = got.left_from_target.rotation.angularDistance(pose.rotation);
    wrong += got.found && turned > 0.2;
    EXPECT_TRUE(got.found) << trial;
  }
  EXPECT_EQ(wrong, 0);
}

TEST_F(Tracking, a_rectangle_becomes_a_metric_model_and_is_followed) {
  auto pose = pose_at(0.05, -0.01, 0.6, 10, -10, 0);
  const auto centre = scene.rig.left.project(pose.translation).value();
  ASSERT_TRUE(sut->choose_rectangle(
      {static_cast<int>(centre.x()) - 24, static_cast<int>(centre.y()) - 16, 49, 33}, 3));
  const PoseEstimate first = see(&pose);
  ASSERT_TRUE(first.found);
  EXPECT_NEAR(first.left_from_target.translation.z(), 0.6, 0.006);
  // It moves by more than a rectangle that stayed where it was drawn could explain.
  pose.translation += Eigen::Vector3d(0.02, 0.015, 0.03);
  PoseEstimate later = see(&pose);
  later = see(&pose);
  ASSERT_TRUE(later.found);
  const Eigen::Vector3d moved =
      later.left_from_target.translation - first.left_from_target.translation;
  EXPECT_LT((moved - Eigen::Vector3d(0.02, 0.015, 0.03)).norm(), 0.006);
}

// The heap counter is in pose_filter_test.cpp, once for the program.
TEST_F(Tracking, takes_no_heap_once_it_exists) {
  if (!test::kCountsHeap) GTEST_SKIP() << "the sanitizer has its own heap";
  const auto pose = pose_at(0.05, -0.01, 0.6, 5, 5, 5);
  const test::Picture left = scene.see(true, &pose, 1);
  const test::Picture right = scene.see(false, &pose, 2);
  const auto frame = [&] {
    now += milliseconds(33);
    return sut->process(left.view(), right.view(), now, ++number, {}, serial).found;
  };
  const std::uint64_t before = test::heap_calls;
  int found = 0;
  sut->choose_model(0, 1);
  for (int i = 0; i < 3; ++i) found += frame();
  sut->choose_rectangle({150, 100, 40, 30}, 2);
  for (int i = 0; i < 3; ++i) found += frame();
  sut->no_frame(now);
  sut->choose_none();
  EXPECT_EQ(test::heap_calls, before);
  EXPECT_GE(found, 5);
}

TEST_F(Tracking, says_within_two_frames_that_its_target_is_gone) {
  const auto at = pose_at(0.05, -0.02, 0.6, 8, -6, 5);
  ASSERT_TRUE(sut->choose_model(0, 1));
  PoseEstimate got;
  for (int i = 0; i < 5; ++i) got = see(&at);
  ASSERT_EQ(got.state, TrackState::kLocked);
  see(nullptr);
  for (int i = 2; i <= 20; ++i) {
    got = see(nullptr);
    EXPECT_FALSE(got.found) << i;
    EXPECT_NE(got.state, TrackState::kLocked) << i;
  }
}

TEST_F(Tracking, refuses_models_and_rectangles_that_are_not_there) {
  EXPECT_FALSE(sut->choose_model(1, 1));
  EXPECT_FALSE(sut->choose_model(-1, 1));
  EXPECT_FALSE(sut->choose_rectangle({310, 0, 20, 20}, 1));
}

TEST_F(Tracking, frames_of_another_size_are_refused) {
  ASSERT_TRUE(sut->choose_model(0, 1));
  test::FlatScene other;
  other.rig.left.width = other.rig.right.width = 200;
  const test::Picture small = other.see(true, nullptr, 1);
  EXPECT_FALSE(sut->process(small.view(), small.view(), now, 1, {}, serial).found);
}

TEST(TrackState, needs_as_many_finds_in_a_row_as_configured) {
  TrackStateMachine sut(3, milliseconds(500));
  const TimePoint t = time_from_ns(0);
  sut.step(true, t);
  sut.step(true, t);
  EXPECT_EQ(sut.step(false, t), TrackState::kSearching);
  sut.step(true, t);
  sut.step(true, t);
  EXPECT_EQ(sut.step(true, t), TrackState::kLocked);
}

TEST(TrackState, coasts_for_as_long_as_configured_and_not_longer) {
  TrackStateMachine sut(1, milliseconds(500));
  const TimePoint t = time_from_ns(0);
  sut.step(true, t);
  EXPECT_EQ(sut.step(false, t + milliseconds(500)), TrackState::kCoasting);
  EXPECT_EQ(sut.step(false, t + milliseconds(501)), TrackState::kLost);
}

}  // namespace
}  // namespace gannet::track
