#include "src/vehicle/arm.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "platform/base/random.hpp"

namespace gannet::vehicle {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr Duration kPeriod = std::chrono::milliseconds(5);

double uniform(Random& random, double least, double most) {
  return least + (most - least) * random.uniform();
}

Joints random_angles(Random& random, int size) {
  Joints q(size);
  for (int i = 0; i < size; ++i) q[i] = uniform(random, -2.0, 2.0);
  return q;
}

ArmConfig custom() {  // a PA-10 whose joints can be changed
  ArmConfig config;
  config.robot = "custom";
  config.joints = pa10_joints();
  return config;
}

Joints rest_of(const ArmConfig& config) {
  const std::vector<JointConfig> joints = joints_of(config);
  Joints q(static_cast<int>(joints.size()));
  for (int i = 0; i < q.size(); ++i) q[i] = joints[static_cast<std::size_t>(i)].rest_deg * kDegree;
  return q;
}

ArmConfig skewed() {  // every parameter says something
  ArmConfig config;
  config.robot = "custom";
  for (int i = 0; i < 6; ++i)
    config.joints.push_back({.a_m = 0.1 * i - 0.2,
                             .alpha_deg = 35.0 * i - 80,
                             .d_m = 0.3 - 0.07 * i,
                             .theta_deg = 20.0 * i});
  config.body_position_m = {0.02, -0.03, 0.1};
  config.body_turn_deg = {10, -70, 25};
  return config;
}

TEST(ArmChain, stands_upright_at_zero) {
  const ArmChain pa10{ArmConfig{}};
  const auto at = pa10.base_from_body(Joints::Zero(7));
  EXPECT_LT((at.translation - Eigen::Vector3d(0, 0, 0.317 + 0.45 + 0.48 + 0.07)).norm(), 1e-12);
  EXPECT_LT((at.rotation * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(ArmChain, bends_at_the_elbow) {
  Joints q = Joints::Zero(7);
  q[3] = std::numbers::pi / 2;  // the forearm is level, towards the base's x
  const auto at = ArmChain{ArmConfig{}}.base_from_body(q);
  EXPECT_LT((at.translation - Eigen::Vector3d(0.48 + 0.07, 0, 0.317 + 0.45)).norm(), 1e-12);
  EXPECT_LT((at.rotation * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitX()).norm(), 1e-12);
}

TEST(ArmChain, jacobian_is_the_numeric_derivative) {
  Random random(1);
  for (const ArmConfig& config : {ArmConfig{}, skewed()}) {
    const ArmChain chain(config);
    for (int trial = 0; trial < 50; ++trial) {
      const Joints q = random_angles(random, chain.size());
      const Jacobian j = chain.jacobian(q);
      constexpr double kStep = 1e-6;
      for (int i = 0; i < chain.size(); ++i) {
        Joints more = q, less = q;
        more[i] += kStep;
        less[i] -= kStep;
        // The motion between them, seen from the middle.
        const auto middle = chain.base_from_body(q);
        const auto a = chain.base_from_body(less), b = chain.base_from_body(more);
        Vector6d numeric;
        numeric << middle.rotation.conjugate() * (b.translation - a.translation),
            rotation_vector_from_quaternion(a.rotation.conjugate() * b.rotation);
        EXPECT_LT((numeric / (2 * kStep) - j.col(i)).norm(), 1e-7) << trial << " joint " << i;
      }
    }
  }
}

JointBounds wide(int size) { return {Joints::Constant(size, -1e6), Joints::Constant(size, 1e6)}; }

TEST(ArmRates, make_the_twist_exactly_away_from_singularities) {
  Random random(2);
  const ArmChain chain{ArmConfig{}};
  int tried = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Jacobian j = chain.jacobian(random_angles(random, 7));
    if (least_singular_value(j, {}) < Damping{}.singular_below) continue;
    ++tried;
    Vector6d twist;
    for (int i = 0; i < 6; ++i) twist[i] = uniform(random, -0.5, 0.5);
    const Joints posture = random_angles(random, 7);
    const Joints rates = joint_rates(j, twist, posture, wide(7), {});
    EXPECT_LT((j * rates - twist).norm(), 1e-9);
    // The posture moves what is left, and that does not move the hand.
    const Joints without = joint_rates(j, twist, Joints::Zero(7), wide(7), {});
    EXPECT_LT((j * (rates - without)).norm(), 1e-9);
    EXPECT_GT((rates - without).dot(posture), 0);
  }
  EXPECT_GT(tried, 50);
}

TEST(ArmRates, stay_small_at_a_singularity) {
  const ArmChain chain{ArmConfig{}};
  Vector6d along;
  along << 0.3, 0, 0, 0, 0, 0;  // out of an arm that is stretched already
  for (const double bend : {0.0, 1e-9, 1e-6, 1e-3, 1e-2}) {
    Joints q = Joints::Zero(7);
    q[3] = bend;
    const Joints rates = joint_rates(chain.jacobian(q), along, Joints::Zero(7), wide(7), {});
    ASSERT_TRUE(rates.allFinite());
    EXPECT_LE(rates.norm(), 0.3 / (2 * 0.05) * 1.5) << bend;
  }
}

TEST(ArmRates, others_make_up_for_a_joint_at_its_bound) {
  const ArmConfig config;
  const ArmChain chain(config);
  Joints q = rest_of(config);
  q[2] = 0.4;
  const Jacobian j = chain.jacobian(q);
  Vector6d twist;
  twist << 0.05, 0.1, -0.05, 0, 0.1, 0;
  JointBounds bounds = wide(7);
  const Joints free = joint_rates(j, twist, Joints::Zero(7), bounds, {});
  constexpr int kAt = 2;  // the elbow can go aside
  bounds.least[kAt] = -0.3 * std::abs(free[kAt]);
  bounds.most[kAt] = 0.3 * std::abs(free[kAt]);
  const Joints bound = joint_rates(j, twist, Joints::Zero(7), bounds, {});
  EXPECT_LE(std::abs(bound[kAt]), bounds.most[kAt] + 1e-12);
  EXPECT_LT((j * bound - twist).norm(), 1e-9);
}

TEST(ArmRates, never_leave_their_bounds) {
  Random random(3);
  const ArmChain chain{skewed()};
  for (int trial = 0; trial < 300; ++trial) {
    JointBounds bounds = {Joints(6), Joints(6)};
    for (int i = 0; i < 6; ++i) {
      bounds.least[i] = uniform(random, -0.5, 0.2);
      bounds.most[i] = bounds.least[i] + uniform(random, 0.0, 0.4);
    }
    Vector6d twist;
    for (int i = 0; i < 6; ++i) twist[i] = uniform(random, -2.0, 2.0);
    const Joints rates = joint_rates(chain.jacobian(random_angles(random, 6)), twist,
                                     random_angles(random, 6), bounds, {});
    ASSERT_TRUE(((rates - bounds.least).array() >= -1e-12).all());
    ASSERT_TRUE(((bounds.most - rates).array() >= -1e-12).all());
  }
}

// The arm with drives that do at once what they are told, and report it.
class ArmRun : public ::testing::Test {
 protected:
  void make(const ArmConfig& config) {
    auto made = Arm::create(config);
    ASSERT_TRUE(made) << made.error().text;
    arm_ = std::move(*made);
    config_ = config;
    config_.joints = joints_of(config);
    angles_ = rest_of(config);
    speeds_ = Joints::Zero(angles_.size());
  }
  const JointConfig& joint(int i) const { return config_.joints[static_cast<std::size_t>(i)]; }
  void sense(Duration age = {}) {
    std::array<hal::DriveFeedback, kMaxJoints> feedback;
    for (int i = 0; i < angles_.size(); ++i) {
      auto& told = feedback[static_cast<std::size_t>(i)];
      told.time = now_ - age;
      told.position_rad = (angles_[i] - joint(i).zero_deg * kDegree) * joint(i).gear_ratio;
      told.speed_rad_s = speeds_[i] * joint(i).gear_ratio;
    }
    arm_->sense(std::span(feedback).first(static_cast<std::size_t>(angles_.size())), now_);
  }
  Reach update(Permit permit) {
    return arm_->update(wish_, permit, kPeriod,
                        std::span(setpoints_).first(static_cast<std::size_t>(angles_.size())));
  }
  double full_speed(int i) const {
    if (!config_.full_speed_rad_s.empty())
      return config_.full_speed_rad_s[static_cast<std::size_t>(i)];
    return joint(i).max_speed_deg_s * kDegree * joint(i).gear_ratio;
  }
  Reach cycle(Permit permit = Permit::kFull) {
    now_ += kPeriod;
    sense();
    const Reach reach = update(permit);
    for (int i = 0; i < angles_.size(); ++i) {
      speeds_[i] =
          setpoints_[static_cast<std::size_t>(i)].value * full_speed(i) / joint(i).gear_ratio;
      angles_[i] += speeds_[i] * to_seconds(kPeriod);
    }
    return reach;
  }
  bool all_zero() const {
    return std::all_of(setpoints_.begin(), setpoints_.end(),
                       [](const hal::DriveSetpoint& s) { return s.value == 0; });
  }

  ArmConfig config_;
  std::unique_ptr<Vehicle> arm_;
  Joints angles_, speeds_;
  MotionWish wish_;
  std::array<hal::DriveSetpoint, kMaxJoints> setpoints_ = {};
  TimePoint now_ = time_from_ns(1'000'000'000);
};

TEST_F(ArmRun, moves_the_hand_as_wished) {
  make({});
  const ArmChain chain(config_);
  wish_.velocity.linear = {0.02, 0.1, -0.05};
  wish_.velocity.angular = {0.1, 0, -0.1};
  for (int i = 0; i < 100; ++i) cycle();
  sense();
  EXPECT_LT((arm_->own_velocity().linear - wish_.velocity.linear).norm(), 1e-3);
  EXPECT_LT((arm_->own_velocity().angular - wish_.velocity.angular).norm(), 1e-3);
}

TEST_F(ArmRun, knows_gears_zeros_and_full_speeds) {
  ArmConfig config = custom();
  for (auto& joint : config.joints) {
    joint.gear_ratio = 50;
    joint.zero_deg = 12;
  }
  config.full_speed_rad_s = {100, 90, 110, 120, 330, 340, 350};
  make(config);
  wish_.velocity.linear = {0, 0.1, 0};
  for (int i = 0; i < 100; ++i) EXPECT_GE(cycle().scale, 0);
  sense();
  EXPECT_LT((arm_->own_velocity().linear - wish_.velocity.linear).norm(), 1e-3);
}

TEST_F(ArmRun, keeps_every_limit_however_far_it_is_sent) {
  make({});
  Random random(4);
  for (int leg = 0; leg < 12; ++leg) {
    for (int k = 0; k < 3; ++k) wish_.velocity.linear[k] = uniform(random, -1.5, 1.5);
    for (int k = 0; k < 3; ++k) wish_.velocity.angular[k] = uniform(random, -3.0, 3.0);
    for (int i = 0; i < 600; ++i) {
      const Joints before = speeds_;
      cycle();
      for (int k = 0; k < 7; ++k) {
        ASSERT_GT(angles_[k], joint(k).min_deg * kDegree) << "joint " << k << " leg " << leg;
        ASSERT_LT(angles_[k], joint(k).max_deg * kDegree) << "joint " << k << " leg " << leg;
        ASSERT_LE(std::abs(speeds_[k]), joint(k).max_speed_deg_s * kDegree + 1e-9);
        const double step = joint(k).max_acceleration_deg_s2 * kDegree * to_seconds(kPeriod);
        const double towards_limit = std::abs(speeds_[k]) - std::abs(before[k]);
        ASSERT_LE(towards_limit, step + 1e-9) << "joint " << k << " leg " << leg;
      }
    }
  }
}

TEST_F(ArmRun, returns_to_its_posture_without_moving_the_hand) {
  ArmConfig config = custom();
  const ArmChain chain(config);
  config.joints[0].rest_deg = 20;  // reached by turning the elbow about shoulder and wrist
  make(config);
  angles_[0] = 0;
  const auto begin = chain.base_from_body(angles_);
  const double far = std::abs(angles_[0] - 20 * kDegree);
  for (int i = 0; i < 1000; ++i) cycle();
  EXPECT_LT(std::abs(angles_[0] - 20 * kDegree), 0.9 * far);
  EXPECT_LT((chain.base_from_body(angles_).translation - begin.translation).norm(), 2e-3);
}

TEST_F(ArmRun, old_or_missing_angles_move_nothing) {
  make({});
  wish_.velocity.linear = {0, 0.1, 0};
  update(Permit::kFull);  // nothing sensed yet
  EXPECT_TRUE(all_zero());
  for (int i = 0; i < 20; ++i) cycle();
  EXPECT_FALSE(all_zero());
  sense(std::chrono::milliseconds(51));
  EXPECT_EQ(update(Permit::kFull).scale, 0);
  EXPECT_TRUE(all_zero());
  EXPECT_EQ(arm_->own_velocity().linear.norm(), 0);
  for (int i = 0; i < 20; ++i) cycle();
  angles_[4] = std::numeric_limits<double>::quiet_NaN();  // a drive that tells no position
  sense();
  update(Permit::kFull);
  EXPECT_TRUE(all_zero());
}

TEST_F(ArmRun, stops_without_permit_and_brakes_to_hold) {
  make({});
  wish_.velocity.linear = {0, 0.2, 0};
  for (int i = 0; i < 100; ++i) cycle();
  EXPECT_FALSE(all_zero());
  for (int i = 0; i < 100; ++i) cycle(Permit::kHoldOnly);
  EXPECT_TRUE(all_zero());
  for (int i = 0; i < 20; ++i) cycle();
  cycle(Permit::kNone);
  EXPECT_TRUE(all_zero());
  wish_.velocity.linear.x() = std::numeric_limits<double>::quiet_NaN();
  cycle();
  EXPECT_TRUE(all_zero());
}

TEST(Arm, refuses_what_is_no_arm) {
  const auto refused = [](auto change) {
    ArmConfig config = custom();
    change(config);
    return !Arm::create(config);
  };
  EXPECT_TRUE(refused([](ArmConfig& c) { c.joints.clear(); }));
  EXPECT_TRUE(refused([](ArmConfig& c) { c.joints.resize(kMaxJoints + 1); }));
  EXPECT_TRUE(refused([](ArmConfig& c) { c.joints[2].max_deg = c.joints[2].min_deg; }));
  EXPECT_TRUE(refused([](ArmConfig& c) { c.joints[2].rest_deg = 173; }));
  EXPECT_TRUE(refused([](ArmConfig& c) { c.full_speed_rad_s = {1, 2}; }));
  EXPECT_FALSE(refused([](ArmConfig&) {}));
}

}  // namespace
}  // namespace gannet::vehicle
