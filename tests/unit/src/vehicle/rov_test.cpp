#include "src/vehicle/rov.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "tests/support/count_heap.hpp"

namespace gannet::vehicle {
namespace {

constexpr Duration kCycle = from_seconds(0.005);
using Setpoints = std::array<hal::DriveSetpoint, 8>;

std::unique_ptr<Vehicle> rov(const RovConfig& config = {}) {
  VehicleConfig vehicle;
  vehicle.kind = "rov";
  vehicle.rov = config;
  return std::move(create_vehicle(vehicle)).value();
}

MotionWish moving(double x, double y, double z, double yaw) {
  MotionWish wish;
  wish.velocity.linear = {x, y, z};
  wish.velocity.angular.z() = yaw;
  return wish;
}

bool all_zero(const Setpoints& setpoints) {
  for (const auto& s : setpoints) {
    if (s.value != 0) return false;
  }
  return true;
}

TEST(Vehicle, without_motors_has_none) {
  const auto sut = std::move(create_vehicle({})).value();
  EXPECT_EQ(sut->motors(), 0);
}

TEST(Vehicle, refuses_what_it_does_not_know) {
  VehicleConfig config;
  config.kind = "balloon";
  EXPECT_FALSE(create_vehicle(config));
  config.kind = "rov";
  EXPECT_TRUE(create_vehicle(config));
  config.rov.controlled = {"x", "sideways"};
  EXPECT_FALSE(create_vehicle(config));
  config.rov.controlled = {};
  EXPECT_FALSE(create_vehicle(config));
  config.rov = RovConfig();
  config.rov.added_mass = {1, 2, 3};
  EXPECT_FALSE(create_vehicle(config));
}

TEST(Rov, commands_nothing_without_a_permit_and_at_once) {
  const auto sut = rov();
  Setpoints setpoints;
  for (int i = 0; i < 200; ++i) {
    sut->update(moving(0.5, 0.2, -0.3, 0.4), Permit::kFull, kCycle, setpoints);
  }
  EXPECT_FALSE(all_zero(setpoints));
  sut->update(moving(0.5, 0.2, -0.3, 0.4), Permit::kNone, kCycle, setpoints);
  EXPECT_TRUE(all_zero(setpoints));
}

TEST(Rov, commands_nothing_for_a_wish_that_is_no_number) {
  const auto sut = rov();
  Setpoints setpoints;
  for (auto& s : setpoints) s.value = 1;
  MotionWish wish = moving(std::numeric_limits<double>::quiet_NaN(), 0, 0, 0);
  sut->update(wish, Permit::kFull, kCycle, setpoints);
  EXPECT_TRUE(all_zero(setpoints));
  sut->update(moving(0.1, 0, 0, 0), Permit::kFull, kCycle, setpoints);
  EXPECT_FALSE(all_zero(setpoints));
}

TEST(Rov, takes_a_hold_for_zero_velocity) {
  const auto held = rov(), zero = rov();
  Setpoints a, b;
  MotionWish wish = moving(0.4, 0, 0, 0.3);
  wish.measured = {{0.1, -0.05, 0.02}, {0, 0, 0.1}};
  wish.measured_valid = true;
  MotionWish still = wish;
  still.velocity = {};
  for (int i = 0; i < 100; ++i) {
    held->update(wish, Permit::kHoldOnly, kCycle, a);
    zero->update(still, Permit::kFull, kCycle, b);
    for (std::size_t k = 0; k < a.size(); ++k) ASSERT_EQ(a[k].value, b[k].value);
  }
  EXPECT_FALSE(all_zero(a));
}

TEST(Rov, moves_as_wished_by_its_own_model) {
  const auto sut = rov();
  Setpoints setpoints;
  for (int i = 0; i < 2000; ++i) {
    sut->update(moving(0.2, -0.1, 0.15, 0.3), Permit::kFull, kCycle, setpoints);
  }
  const Twist<Body> v = sut->own_velocity();
  EXPECT_LT((v.linear - Eigen::Vector3d(0.2, -0.1, 0.15)).norm(), 0.01);
  EXPECT_NEAR(v.angular.z(), 0.3, 0.01);
  EXPECT_EQ(v.angular.x(), 0);
}

// Full thrust forward: 4 motors at 45° give what the backward pair limits; speed where drag equals.
TEST(Rov, reaches_the_speed_where_drag_equals_thrust) {
  RovConfig config;
  config.controlled = {"x"};
  const auto sut = rov(config);
  Setpoints setpoints;
  Reach reach;
  for (int i = 0; i < 4000; ++i) {
    reach = sut->update(moving(5, 0, 0, 0), Permit::kFull, kCycle, setpoints);
  }
  EXPECT_LT(reach.scale, 0.5);
  EXPECT_NEAR(reach.reached.force.x(), 4 * 39.9 * std::sqrt(0.5), 0.01);
  const double v = sut->own_velocity().linear.x();
  EXPECT_NEAR(4.03 * v + 18.18 * v * v, reach.reached.force.x(), 0.1);
}

TEST(Rov, slews_all_thrusters_together) {
  RovConfig config;
  config.slew_n_s = 100;
  const auto sut = rov(config);
  Setpoints setpoints;
  MotionWish wish = moving(0.4, 0.2, 0.1, 0.2);
  wish.measured_valid = true;
  std::array<double, 6> last = {};
  for (int i = 0; i < 30; ++i) {
    const Reach reach = sut->update(wish, Permit::kFull, kCycle, setpoints);
    // Before it arrives the force points where it shall go.
    if (i < 5) {
      const Eigen::Vector3d a = reach.reached.force, b = reach.wished.force;
      EXPECT_GT(a.dot(b) / (a.norm() * b.norm()), 0.999);
    }
    for (std::size_t k = 0; k < last.size(); ++k) {
      const double thrust = thrust_of(config.curve, setpoints[k].value);
      EXPECT_LE(std::abs(thrust - last[k]), 100 * 0.005 + 1e-6);
      last[k] = thrust;
    }
  }
}

// The measured velocity stays behind what 5 m/s would need: without anti-windup the integral would
// grow by mass · gain · error · time.
TEST(Rov, does_not_wind_up_while_saturated) {
  RovConfig config;
  config.acceleration_smoothing_s = 0;
  config.slew_n_s = 1e6;
  const auto sut = rov(config);
  Setpoints setpoints;
  MotionWish wish = moving(3, 0, 0, 0);
  wish.measured_valid = true;
  for (int i = 0; i < 4000; ++i) sut->update(wish, Permit::kFull, kCycle, setpoints);
  wish = moving(0, 0, 0, 0);
  wish.measured_valid = true;
  int cycles = 0;
  double force = 0;
  do {
    force = sut->update(wish, Permit::kFull, kCycle, setpoints).reached.force.x();
  } while (std::abs(force) > 1 && ++cycles < 4000);
  EXPECT_LT(cycles * 0.005, 1.5);
}

TEST(Rov, takes_away_a_constant_push_by_the_integral) {
  const auto sut = rov();
  Setpoints setpoints;
  double v = 0, force = 0;
  for (int i = 0; i < 6000; ++i) {
    MotionWish wish = moving(0, 0, 0, 0);
    wish.measured.linear.x() = v;
    wish.measured_valid = true;
    force = sut->update(wish, Permit::kFull, kCycle, setpoints).reached.force.x();
    v += 0.005 / 17 * (force + 8 - 4.03 * v);
  }
  EXPECT_NEAR(v, 0, 1e-3);
  EXPECT_NEAR(force, -8, 0.05);
}

TEST(Rov, forgets_when_reset_and_repeats_bit_for_bit) {
  const auto sut = rov(), fresh = rov();
  Setpoints a, b;
  for (int i = 0; i < 300; ++i) sut->update(moving(0.3, 0, 0, 0), Permit::kFull, kCycle, a);
  sut->update({}, Permit::kNone, kCycle, a);
  sut->reset();
  for (int i = 0; i < 300; ++i) {
    MotionWish wish = moving(0.1, 0.2, 0, -0.1);
    wish.measured.linear.y() = 0.01 * i;
    wish.measured_valid = i % 3 != 0;
    sut->update(wish, Permit::kFull, kCycle, a);
    fresh->update(wish, Permit::kFull, kCycle, b);
    for (std::size_t k = 0; k < a.size(); ++k) ASSERT_EQ(a[k].value, b[k].value);
  }
}

TEST(Rov, writes_nothing_into_too_little_room) {
  const auto sut = rov();
  std::array<hal::DriveSetpoint, 3> few;
  sut->update(moving(0.3, 0, 0, 0), Permit::kFull, kCycle, few);
  for (const auto& s : few) EXPECT_EQ(s.value, 0);
}

TEST(Rov, takes_nothing_from_the_heap_after_creation) {
  if (!test::kCountsHeap) GTEST_SKIP() << "the sanitizer has its own heap";
  RovConfig config;
  config.frame = "vectored_6dof";
  config.controlled = {"x", "y", "z", "roll", "pitch", "yaw"};
  const auto sut = rov(config);
  Setpoints setpoints;
  MotionWish wish = moving(1, 0.3, 0.2, 1);
  wish.measured_valid = true;
  const auto before = test::heap_calls;
  for (int i = 0; i < 1000; ++i) {
    sut->update(wish, static_cast<Permit>(i % 3), kCycle, setpoints);
  }
  sut->reset();
  EXPECT_EQ(test::heap_calls, before);
  const auto watched = std::make_unique<int>(1);
  EXPECT_GT(test::heap_calls, before);  // it does count
}

}  // namespace
}  // namespace gannet::vehicle
