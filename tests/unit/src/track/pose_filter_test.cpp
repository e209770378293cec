#include "src/track/pose_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "platform/base/random.hpp"
#include "tests/support/count_heap.hpp"

namespace gannet::track {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Pose = Transform<LeftCamera, Target>;

TimePoint at(double s) { return time_from_ns(5'000'000'000) + from_seconds(s); }

// Box–Muller, for the χ² bounds want true tails.
double normal(Random& random) {
  return std::sqrt(-2 * std::log(1 - random.uniform())) *
         std::cos(2 * 3.14159265358979 * random.uniform());
}
Vector3d normals(Random& random, double sigma) {
  return sigma * Vector3d(normal(random), normal(random), normal(random));
}

PoseEstimate seen(const Pose& pose, double time, double sigma_m = 0.002, double sigma_rad = 0.01) {
  PoseEstimate e;
  e.capture_time = at(time);
  e.target_id = 1;
  e.found = true;
  e.state = TrackState::kLocked;
  e.left_from_target = pose;
  e.covariance.diagonal() << Vector3d::Constant(sigma_m * sigma_m),
      Vector3d::Constant(sigma_rad * sigma_rad);
  return e;
}

Pose noisy(const Pose& pose, Random& random, double sigma_m, double sigma_rad) {
  return {quaternion_from_rotation_vector(normals(random, sigma_rad)) * pose.rotation,
          pose.translation + normals(random, sigma_m)};
}

struct Mover {  // constant velocity in the camera's axes
  Pose start;
  Vector3d linear, angular;
  Pose at_time(double t) const {
    return {quaternion_from_rotation_vector(angular * t) * start.rotation,
            start.translation + linear * t};
  }
};

Mover mover() {
  return {{quaternion_from_rpy(0.1, -0.2, 0.3), {0.05, -0.1, 0.7}},
          {0.04, -0.03, 0.02},
          {0.1, 0.2, -0.15}};
}

double rotation_distance(const Quaterniond& a, const Quaterniond& b) {
  return rotation_vector_from_quaternion(a * b.conjugate()).norm();
}

TEST(PoseFilter, predicts_a_constant_velocity_exactly_once_it_has_learnt_it) {
  FilterConfig config;
  config.acceleration_density = 1e-4;
  config.angular_acceleration_density = 1e-4;
  config.initial_speed_m_s = 10;
  config.initial_rate_rad_s = 10;
  config.least_sigma_m = 1e-6;
  config.least_sigma_rad = 1e-6;
  PoseFilter sut(config);
  const Mover truth = mover();
  double t = 0;
  for (; t < 3; t += 1.0 / 30) sut.update(seen(truth.at_time(t), t, 1e-6, 1e-6), at(t + 0.04));
  const double now = t + 0.08;
  const PredictedPose out = sut.predict(at(now));
  ASSERT_TRUE(out.valid);
  EXPECT_LT((out.left_from_target.translation - truth.at_time(now).translation).norm(), 1e-6);
  EXPECT_LT(rotation_distance(out.left_from_target.rotation, truth.at_time(now).rotation), 1e-6);
  EXPECT_LT((out.target.linear - truth.linear).norm(), 1e-5);
  EXPECT_LT((out.target.angular - truth.angular).norm(), 1e-5);
  EXPECT_LT((out.relative.linear - truth.linear).norm(), 1e-5);
  EXPECT_NEAR(to_seconds(out.age), now - (t - 1.0 / 30), 1e-6);
}

TEST(PoseFilter, passes_the_pose_at_capture_on_if_it_shall_not_predict) {
  FilterConfig config;
  config.predict = false;
  PoseFilter sut(config);
  const Mover truth = mover();
  double t = 0;
  for (; t < 2; t += 1.0 / 30) sut.update(seen(truth.at_time(t), t), at(t + 0.04));
  const PredictedPose out = sut.predict(at(t + 0.1));
  const Pose last = truth.at_time(t - 1.0 / 30);
  EXPECT_LT((out.left_from_target.translation - last.translation).norm(), 1e-3);
  EXPECT_NEAR(to_seconds(out.age), 0.1 + 1.0 / 30, 1e-6);
}

// A vehicle moves on a curve of constant twist before a target at rest; told of it, the filter
// says that the target rests, and predicts across the latency exactly.
TEST(PoseFilter, takes_the_own_motion_out) {
  FilterConfig config;
  PoseFilter sut(config);
  const Twist<LeftCamera> own = {{0.2, -0.1, 0.15}, {0.1, 0.4, -0.05}};
  const Pose world_from_target = {quaternion_from_rpy(0.1, 0.2, 0.3), {0.1, 0, 0.9}};
  Transform<LeftCamera, LeftCamera> world_from_camera;
  const double dt = 1e-3;
  const Vector3d step_angle = own.angular * dt;
  for (int i = 0; i < 2000; ++i) {
    sut.note_own_motion(at(i * dt), own);
    if (i % 33 == 0 && i < 1900) {
      sut.update(seen(world_from_camera.inverse() * world_from_target, i * dt), at(i * dt));
    }
    // The exact motion of a constant twist, by many small steps about the middle of each.
    const Quaterniond half = quaternion_from_rotation_vector(step_angle / 2);
    world_from_camera.translation += world_from_camera.rotation * (half * (own.linear * dt));
    world_from_camera.rotation =
        world_from_camera.rotation * quaternion_from_rotation_vector(step_angle);
  }
  const PredictedPose out = sut.predict(at(2.0));
  const Pose truth = world_from_camera.inverse() * world_from_target;
  EXPECT_LT((out.left_from_target.translation - truth.translation).norm(), 1e-5);
  EXPECT_LT(rotation_distance(out.left_from_target.rotation, truth.rotation), 1e-5);
  EXPECT_LT(out.target.linear.norm(), 1e-4);
  EXPECT_LT(out.target.angular.norm(), 1e-4);
  const Vector3d rate = -own.linear - own.angular.cross(truth.translation);
  EXPECT_LT((out.relative.linear - rate).norm(), 1e-3);
}

TEST(OwnMotion, adds_up_over_any_cut) {
  Random random(3);
  OwnMotion sut;
  for (int i = 0; i < 1500; ++i) {
    sut.note(at(0.005 * i), {normals(random, 0.3), normals(random, 0.5)});
  }
  for (int i = 0; i < 100; ++i) {
    const double a = 4 + random.uniform(), c = a + random.uniform(), b = a + (c - a) * 0.37;
    const auto whole = sut.displacement(at(a), at(c));
    const auto parts = sut.displacement(at(a), at(b)) * sut.displacement(at(b), at(c));
    EXPECT_LT((whole.translation - parts.translation).norm(), 1e-9);
    EXPECT_LT(rotation_distance(whole.rotation, parts.rotation), 1e-9);
  }
  EXPECT_EQ(OwnMotion().displacement(at(0), at(5)).translation.norm(), 0);
}

// The same scene seen by a camera that is mounted turned gives the same, turned.
TEST(PoseFilter, does_not_care_how_the_camera_is_turned) {
  const Quaterniond turn = quaternion_from_rpy(0.7, -1.1, 2.3);
  const Eigen::Matrix3d r = turn.toRotationMatrix();
  PoseFilter plain(FilterConfig{}), turned(FilterConfig{});
  Random random(9);
  const Mover truth = mover();
  for (double t = 0; t < 2; t += 1.0 / 30) {
    const Twist<LeftCamera> own = {normals(random, 0.1), normals(random, 0.1)};
    plain.note_own_motion(at(t), own);
    turned.note_own_motion(at(t), {turn * own.linear, turn * own.angular});
    PoseEstimate e = seen(noisy(truth.at_time(t), random, 0.003, 0.02), t);
    const Eigen::Matrix<double, 6, 6> a = 1e-3 * Matrix6d::Random();
    e.covariance += a * a.transpose();
    plain.update(e, at(t));
    e.left_from_target.translation = turn * e.left_from_target.translation;
    e.left_from_target.rotation = turn * e.left_from_target.rotation;
    Matrix6d rr = Matrix6d::Zero();
    rr.topLeftCorner<3, 3>() = r;
    rr.bottomRightCorner<3, 3>() = r;
    e.covariance = (rr * e.covariance * rr.transpose()).eval();
    turned.update(e, at(t));
    const PredictedPose p = plain.predict(at(t + 0.05)), q = turned.predict(at(t + 0.05));
    ASSERT_LT((turn * p.left_from_target.translation - q.left_from_target.translation).norm(),
              1e-9);
    ASSERT_LT(rotation_distance(turn * p.left_from_target.rotation, q.left_from_target.rotation),
              1e-9);
    ASSERT_LT((turn * p.target.linear - q.target.linear).norm(), 1e-9);
    ASSERT_NEAR(p.covariance.trace(), q.covariance.trace(), 1e-9);
  }
}

// Normalised estimation error squared over trials of the model itself: 12 degrees of freedom.
// Sum over 150 independent trials ~ χ²(1800): mean 1800, σ 60; bounds at 4 σ.
TEST(PoseFilter, is_as_sure_as_it_may_be) {
  FilterConfig config;
  config.acceleration_density = 0.2;
  config.angular_acceleration_density = 0.5;
  config.initial_speed_m_s = 0.1;
  config.initial_rate_rad_s = 0.2;
  config.least_sigma_m = 1e-6;
  config.least_sigma_rad = 1e-6;
  config.gate = 1e9;
  constexpr int kTrials = 150;
  constexpr double kStep = 1.0 / 30 / 4;
  double sum = 0, pose_sum = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    Random random(static_cast<std::uint64_t>(trial) + 1);
    PoseFilter sut(config);
    Pose pose = {quaternion_from_rotation_vector(normals(random, 1)), {0, 0, 0.6}};
    Vector3d v = normals(random, 0.1), w = normals(random, 0.2);
    double t = 0;
    for (int i = 0; i < 4 * 45; ++i, t += kStep) {
      if (i % 4 == 0) {
        sut.update(seen(noisy(pose, random, 0.003, 0.02), t, 0.003, 0.02), at(t));
      }
      // White acceleration, integrated exactly over the step (correlated position and velocity).
      const auto advance = [&](Vector3d& velocity, double density) {
        const Vector3d a = normals(random, density * std::sqrt(kStep));
        const Vector3d b = normals(random, density * std::sqrt(kStep * kStep * kStep / 12));
        const Vector3d moved = velocity * kStep + a * kStep / 2 + b;
        velocity += a;
        return moved;
      };
      pose.translation += advance(v, 0.2);
      pose.rotation = quaternion_from_rotation_vector(advance(w, 0.5)) * pose.rotation;
    }
    const PredictedPose out = sut.predict(at(t));
    Eigen::Matrix<double, 12, 1> error;
    error << pose.translation - out.left_from_target.translation,
        rotation_vector_from_quaternion(pose.rotation * out.left_from_target.rotation.conjugate()),
        v - out.target.linear, w - out.target.angular;
    sum += error.dot(out.covariance.inverse() * error);
    const Vector6d part = error.head<6>();
    pose_sum += part.dot(out.covariance.topLeftCorner<6, 6>().inverse() * part);
  }
  EXPECT_NEAR(sum, 12 * kTrials, 4 * std::sqrt(2.0 * 12 * kTrials));
  EXPECT_NEAR(pose_sum, 6 * kTrials, 4 * std::sqrt(2.0 * 6 * kTrials));
}

TEST(PoseFilter, refuses_what_is_late_early_or_no_measurement) {
  PoseFilter sut(FilterConfig{});
  const Pose pose = mover().start;
  EXPECT_FALSE(sut.predict(at(0)).valid);
  EXPECT_EQ(sut.update(seen(pose, 1), at(1.04)), FilterResult::kStarted);
  EXPECT_EQ(sut.update(seen(pose, 1.03), at(1.07)), FilterResult::kUpdated);
  EXPECT_EQ(sut.update(seen(pose, 1.03), at(1.08)), FilterResult::kOutOfOrder);
  EXPECT_EQ(sut.update(seen(pose, 1.0), at(1.08)), FilterResult::kOutOfOrder);
  EXPECT_EQ(sut.update(seen(pose, 1.2), at(1.1)), FilterResult::kFuture);
  PoseEstimate bad = seen(pose, 1.06);
  bad.found = false;
  EXPECT_EQ(sut.update(bad, at(1.1)), FilterResult::kNotFound);
  bad = seen(pose, 1.06);
  bad.left_from_target.translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(sut.update(bad, at(1.1)), FilterResult::kInvalid);
  bad = seen(pose, 1.06);
  bad.covariance(2, 2) = -1;
  EXPECT_EQ(sut.update(bad, at(1.1)), FilterResult::kInvalid);
  bad = seen(pose, 1.06);
  bad.left_from_target.rotation = Quaterniond(0, 0, 0, 0);
  EXPECT_EQ(sut.update(bad, at(1.1)), FilterResult::kInvalid);
  EXPECT_EQ(sut.counters().updated, 1u);
  EXPECT_EQ(sut.counters().out_of_order, 2u);
  EXPECT_EQ(sut.counters().invalid, 4u);
  EXPECT_FALSE(sut.predict(at(1.0)).valid);
  EXPECT_FALSE(sut.predict(at(1.03 + 2.1)).valid);
}

TEST(PoseFilter, ignores_outliers_but_follows_a_jump_that_stays) {
  PoseFilter sut(FilterConfig{});
  const Pose here = mover().start;
  Pose there = here;
  there.translation.x() += 0.2;
  double t = 0;
  const auto next = [&](const Pose& pose) {
    t += 1.0 / 30;
    return sut.update(seen(pose, t), at(t));
  };
  for (int i = 0; i < 60; ++i) next(here);
  EXPECT_EQ(next(there), FilterResult::kRejected);
  EXPECT_GT(sut.last_distance(), 35);
  EXPECT_LT((sut.predict(at(t)).left_from_target.translation - here.translation).norm(), 0.005);
  EXPECT_EQ(next(here), FilterResult::kUpdated);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(next(there), FilterResult::kRejected);
  EXPECT_EQ(next(there), FilterResult::kReset);
  EXPECT_LT((sut.predict(at(t)).left_from_target.translation - there.translation).norm(), 1e-9);
}

TEST(PoseFilter, starts_anew_for_another_target_and_after_a_gap) {
  PoseFilter sut(FilterConfig{});
  sut.update(seen(mover().start, 0), at(0));
  sut.update(seen(mover().start, 0.03), at(0.03));
  EXPECT_EQ(sut.update(seen(mover().start, 1.1), at(1.1)), FilterResult::kStarted);
  PoseEstimate other = seen(mover().start, 1.13);
  other.target_id = 2;
  EXPECT_EQ(sut.update(other, at(1.13)), FilterResult::kStarted);
  EXPECT_EQ(sut.predict(at(1.2)).target_id, 2u);
  sut.clear();
  EXPECT_FALSE(sut.predict(at(1.2)).valid);
}

TEST(PoseFilter, takes_nothing_from_the_heap) {
  if (!test::kCountsHeap) GTEST_SKIP() << "the sanitizer has its own heap";
  PoseFilter sut(FilterConfig{});
  const Mover truth = mover();
  const auto before = test::heap_calls;
  for (int i = 0; i < 600; ++i) {
    const double t = 0.005 * i;
    sut.note_own_motion(at(t), {{0.1, 0, 0}, {0, 0.1, 0}});
    if (i % 7 == 0) sut.update(seen(truth.at_time(t), t), at(t));
    sut.predict(at(t));
  }
  EXPECT_EQ(test::heap_calls, before);
  const auto watched = std::make_unique<int>(1);
  EXPECT_GT(test::heap_calls, before);  // it does count
}

}  // namespace
}  // namespace gannet::track
