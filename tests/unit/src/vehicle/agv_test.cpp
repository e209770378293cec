#include "src/vehicle/agv.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/heap_calls.hpp"

namespace gannet::vehicle {
namespace {

constexpr Duration kCycle = from_seconds(0.005);
constexpr double kSeconds = 0.005;
using Setpoints = std::array<hal::DriveSetpoint, 2>;

std::unique_ptr<Vehicle> agv(const AgvConfig& config = {}) {
  return std::move(Agv::create(config)).value();
}

MotionWish driving(double speed, double turn) {
  MotionWish wish;
  wish.velocity.linear.x() = speed;
  wish.velocity.angular.z() = turn;
  return wish;
}

// What the setpoints mean, by the config's own full speed of 16 rad/s · 0.1 m.
double speed_of(const Setpoints& s) { return (s[0].value + s[1].value) / 2 * 1.6; }
double turn_of(const Setpoints& s) { return (s[1].value - s[0].value) * 1.6 / 0.5; }

Setpoints after(Vehicle& sut, const MotionWish& wish, double seconds,
                Permit permit = Permit::kFull) {
  Setpoints setpoints;
  for (int i = 0; i < static_cast<int>(std::lround(seconds / kSeconds)); ++i)
    sut.update(wish, permit, kCycle, setpoints);
  return setpoints;
}

hal::DriveFeedback turning(double speed_rad_s, TimePoint time) {
  return {.state = hal::DriveState::kEnabled, .time = time, .speed_rad_s = speed_rad_s};
}

TEST(Agv, drives_its_wheels_at_the_wished_speed_and_turn) {
  const auto sut = agv();
  const Setpoints s = after(*sut, driving(0.8, 0.6), 4);
  EXPECT_NEAR(s[0].value, (0.8 - 0.6 * 0.25) / 1.6, 1e-9);
  EXPECT_NEAR(s[1].value, (0.8 + 0.6 * 0.25) / 1.6, 1e-9);
}

TEST(Agv, counts_setpoints_by_the_drives_full_speed) {
  AgvConfig config;
  config.full_speed_rad_s = {300, 600};
  const auto sut = agv(config);
  const Setpoints s = after(*sut, driving(1, 0), 4);
  EXPECT_NEAR(s[0].value, 1 / 0.1 * 15 / 300, 1e-9);
  EXPECT_NEAR(s[1].value, 1 / 0.1 * 15 / 600, 1e-9);
}

TEST(Agv, keeps_its_curve_when_the_wheels_cannot_go_so_fast) {
  const auto sut = agv();
  const Setpoints s = after(*sut, driving(3, 2), 10);
  EXPECT_NEAR(s[1].value, 1, 1e-9);
  EXPECT_NEAR(turn_of(s) / speed_of(s), 2.0 / 3, 1e-9);
}

TEST(Agv, keeps_its_limits_of_acceleration_and_jerk_and_does_not_overshoot) {
  const auto sut = agv();
  Setpoints s;
  double speed = 0, acceleration = 0;
  for (int i = 0; i < 1200; ++i) {
    sut->update(driving(i < 600 ? 1.2 : 0.3, 0), Permit::kFull, kCycle, s);
    const double now = (speed_of(s) - speed) / kSeconds;
    EXPECT_LE(std::abs(now), 1.0 + 1e-9);
    EXPECT_LE(std::abs(now - acceleration), 2 * 8 * kSeconds + 1e-9) << i;
    EXPECT_LE(speed_of(s), 1.2 + 1e-9);
    if (i > 900) {
      EXPECT_GE(speed_of(s), 0.3 - 1e-9);
    }
    speed = speed_of(s);
    acceleration = now;
  }
  EXPECT_NEAR(speed, 0.3, 1e-9);
}

TEST(Agv, never_drives_backwards_but_with_a_free_rear) {
  const auto sut = agv();
  after(*sut, driving(0.5, 0), 2);
  Setpoints s;
  for (int i = 0; i < 600; ++i) {
    sut->update(driving(-0.5, 0), Permit::kFull, kCycle, s);
    EXPECT_GE(speed_of(s), 0);
  }
  EXPECT_EQ(speed_of(s), 0);
  AgvConfig config;
  config.rear_free = true;
  EXPECT_NEAR(speed_of(after(*agv(config), driving(-0.5, 0), 4)), -0.5, 1e-9);
}

TEST(Agv, slows_down_softly_while_it_may_only_hold) {
  const auto sut = agv();
  Setpoints s = after(*sut, driving(1, 0), 4);
  double speed = speed_of(s);
  for (int i = 0; i < 600; ++i) {
    sut->update(driving(1, 0), Permit::kHoldOnly, kCycle, s);
    EXPECT_GE(speed_of(s) - speed, -0.5 * kSeconds - 1e-9);
    speed = speed_of(s);
  }
  EXPECT_EQ(speed, 0);
}

TEST(Agv, stops_at_once_without_a_permit) {
  const auto sut = agv();
  after(*sut, driving(1, 0.5), 4);
  const Setpoints s = after(*sut, driving(1, 0.5), kSeconds, Permit::kNone);
  EXPECT_EQ(s[0].value, 0);
  EXPECT_EQ(s[1].value, 0);
}

TEST(Agv, takes_its_own_motion_from_its_wheels) {
  const auto sut = agv();
  const TimePoint now = time_from_ns(5'000'000'000);
  const std::array<hal::DriveFeedback, 2> wheels = {turning(75, now), turning(150, now)};
  sut->sense(wheels, now);
  EXPECT_NEAR(sut->own_velocity().linear.x(), 0.75, 1e-12);
  EXPECT_NEAR(sut->own_velocity().angular.z(), 1, 1e-12);
}

TEST(Agv, takes_what_it_commands_where_a_wheel_is_silent) {
  const auto sut = agv();
  after(*sut, driving(0.4, 0), 4);
  const TimePoint now = time_from_ns(5'000'000'000);
  const std::array<hal::DriveFeedback, 2> wheels = {turning(75, now),
                                                    turning(75, now - from_seconds(0.2))};
  sut->sense(wheels, now);
  EXPECT_NEAR(sut->own_velocity().linear.x(), 0.4, 1e-9);
}

TEST(Agv, takes_nothing_from_the_heap_after_creation) {
  if (!test::kCountsHeap) GTEST_SKIP() << "the sanitizer has its own heap";
  const auto sut = agv();
  const TimePoint now = time_from_ns(5'000'000'000);
  const std::array<hal::DriveFeedback, 2> wheels = {turning(75, now), turning(150, now)};
  Setpoints s;
  const auto before = test::heap_calls;
  sut->sense(wheels, now);
  sut->update(driving(1, 1), Permit::kFull, kCycle, s);
  EXPECT_EQ(test::heap_calls, before);
}

TEST(Agv, needs_two_drives) {
  AgvConfig config;
  config.full_speed_rad_s = {300};
  EXPECT_FALSE(Agv::create(config));
}

}  // namespace
}  // namespace gannet::vehicle
