#include "src/world/thruster.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gannet::world {
namespace {

double settled_thrust(double throttle) {
  Thruster sut;
  sut.command(throttle);
  for (int i = 0; i < 5000; ++i) sut.advance(0.001);
  return sut.thrust_n();
}

TEST(Thruster, gives_the_published_thrust) {
  EXPECT_NEAR(settled_thrust(1), 51.45, 0.01);  // 5.245 kgf
  EXPECT_NEAR(settled_thrust(-1), -39.92, 0.01);
  EXPECT_NEAR(settled_thrust(0.5), 17.89, 0.01);
  EXPECT_NEAR(settled_thrust(-0.3), -6.36, 0.01);
}

TEST(Thruster, stands_still_in_the_dead_band) {
  for (const double throttle : {-0.069, -0.03, 0.0, 0.02, 0.07})
    EXPECT_EQ(settled_thrust(throttle), 0) << throttle;
  EXPECT_GT(settled_thrust(0.08), 0.3);
  EXPECT_LT(settled_thrust(-0.08), -0.3);
}

TEST(Thruster, thrust_grows_with_throttle_everywhere) {
  double last = settled_thrust(-1);
  for (double throttle = -0.99; throttle <= 1; throttle += 0.01) {
    const double thrust = settled_thrust(throttle);
    EXPECT_GE(thrust, last) << throttle;
    last = thrust;
  }
}

TEST(Thruster, lags_as_a_first_order_system) {
  Thruster sut;
  sut.command(0.6);
  const double steady = steady_speed_rad_s(0.6);
  for (int i = 0; i < 200; ++i) sut.advance(0.001);
  EXPECT_NEAR(sut.speed_rad_s(), steady * (1 - std::exp(-1)), 1e-9);
  Thruster coarse;  // one step as long as the two hundred
  coarse.command(0.6);
  coarse.advance(0.2);
  EXPECT_NEAR(coarse.speed_rad_s(), sut.speed_rad_s(), 1e-9);
}

TEST(Thruster, takes_wrong_commands_safely) {
  Thruster sut;
  sut.command(7);
  EXPECT_EQ(sut.throttle(), 1);
  sut.command(-7);
  EXPECT_EQ(sut.throttle(), -1);
  sut.command(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(sut.throttle(), 0);
}

TEST(Thruster, jammed_it_gives_nothing) {
  Thruster sut;
  sut.command(1);
  sut.advance(1);
  sut.jam(true);
  sut.advance(0.001);
  EXPECT_EQ(sut.thrust_n(), 0);
}

}  // namespace
}  // namespace gannet::world
