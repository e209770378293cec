#include "src/world/cia402_nodes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "hal/drive/cia402_drive.hpp"
#include "src/world/thruster.hpp"

namespace gannet::world {
namespace {

using std::chrono::milliseconds;

hal::DriveConfig config_of(int motors) {
  hal::DriveConfig config;
  config.kind = "cia402";
  for (int i = 0; i < motors; ++i) {
    config.motors.push_back({.node_id = 30 + i, .reversed = i == 1, .full_speed_rad_s = 370});
  }
  return config;
}

struct Bench {
  explicit Bench(const hal::DriveConfig& config)
      : drive(std::move(hal::Cia402Drive::create(config)).value()),
        sut(config, 5),
        setpoints(config.motors.size()) {}

  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      now += milliseconds(5);
      for (const hal::CanFrame& frame : said) drive->receive(frame, now);
      said.clear();
      health = drive->health(now);
      hal::CanFrame out[64];
      const int n = drive->send(setpoints, enable, now, out);
      throttles = sut.step(now, std::span(out).first(static_cast<std::size_t>(n)), said);
      for (int m = 0; m < sut.motors(); ++m) {
        const double speed = steady_speed_rad_s(throttles[static_cast<std::size_t>(m)]);
        sut.report(m, {.speed_rad_s = speed, .current_a = 3, .voltage_v = 15});
      }
    }
  }

  std::unique_ptr<hal::Cia402Drive> drive;
  Cia402Nodes sut;
  std::vector<hal::DriveSetpoint> setpoints;
  std::vector<hal::CanFrame> said;
  std::span<const double> throttles;
  hal::DriveGroupHealth health;
  bool enable = false;
  TimePoint now = {};
};

TEST(Cia402Nodes, TurnTheThrusterAtTheSpeedThatWasAskedFor) {
  Bench bench(config_of(3));
  bench.run(200);
  ASSERT_TRUE(bench.health.all_ready);
  EXPECT_FALSE(bench.sut.armed());
  bench.enable = true;
  bench.setpoints[0].value = 0.5;
  bench.setpoints[1].value = -0.5;
  bench.run(100);
  EXPECT_TRUE(bench.sut.armed());
  EXPECT_NEAR(steady_speed_rad_s(bench.throttles[0]), 185, 0.2);
  EXPECT_NEAR(steady_speed_rad_s(bench.throttles[1]), -185, 0.2);
  EXPECT_EQ(bench.throttles[2], 0);
  EXPECT_NEAR(bench.drive->feedback()[1].speed_rad_s, -185, 0.2);
  EXPECT_NEAR(bench.drive->feedback()[1].current_a, 3, 1e-9);
  bench.enable = false;
  bench.run(100);
  EXPECT_FALSE(bench.sut.armed());
  EXPECT_EQ(bench.throttles[0], 0);
}

TEST(Cia402Nodes, AFaultyOneStandsStillAndSaysWhy) {
  Bench bench(config_of(2));
  bench.run(200);
  bench.enable = true;
  bench.setpoints[0].value = bench.setpoints[1].value = 0.4;
  bench.run(100);
  bench.sut.faults(1).faulty = true;
  bench.run(40);
  EXPECT_GT(bench.throttles[0], 0);
  EXPECT_EQ(bench.throttles[1], 0);
  EXPECT_TRUE(bench.health.any_fault);
  EXPECT_EQ(bench.health.first_bad, 1);
  EXPECT_EQ(bench.health.trouble_code, 0x4310u);
}

TEST(Cia402Nodes, ASilentOneStopsByItsOwnGuard) {
  Bench bench(config_of(1));
  bench.run(200);
  bench.enable = true;
  bench.setpoints[0].value = 0.4;
  bench.run(100);
  bench.sut.faults(0).silent = true;
  bench.run(60);
  EXPECT_EQ(bench.throttles[0], 0);
  EXPECT_TRUE(bench.said.empty());
}

TEST(Cia402Nodes, GarbageIsCountedOrIgnoredAndBreaksNothing) {
  Bench bench(config_of(2));
  bench.sut.faults(0).garbage = 0.3;
  bench.run(3000);
  EXPECT_TRUE(std::isfinite(bench.drive->feedback()[0].speed_rad_s));
}

TEST(Cia402Nodes, ThrottleAndSpeedAreInverse) {
  for (const double speed : {-360.0, -150.0, -40.0, 40.0, 150.0, 360.0}) {
    EXPECT_NEAR(steady_speed_rad_s(throttle_at_speed(speed)), speed, 1e-6);
  }
  EXPECT_EQ(throttle_at_speed(0), 0);
}

}  // namespace
}  // namespace gannet::world
