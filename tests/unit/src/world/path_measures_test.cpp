#include "src/world/path_measures.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "src/world/motion.hpp"

namespace gannet::world {
namespace {

constexpr double kPi = 3.14159265358979323846;

// A hand that follows a target moved by many sines as a lag of the first order does, exactly.
Trace lagging(double lag_s) {
  Trace trace;
  for (int i = 0; i <= 4000; ++i) {
    TraceRow row;
    row.time_s = i * trace.period_s;
    Eigen::Vector3d target = {0, 0, 0.5}, hand = Eigen::Vector3d::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      for (const double frequency_hz : multisine_hz(axis)) {
        const double rate = 2 * kPi * frequency_hz;
        const std::complex<double> turning = std::polar(0.01, rate * row.time_s);
        target[axis] += turning.imag();
        hand[axis] += (turning / std::complex<double>(1, rate * lag_s)).imag();
      }
    }
    row.vehicle.translation = hand;
    row.target.translation = target - hand;
    row.error_m = row.target.translation - Eigen::Vector3d(0, 0, 0.5);
    trace.rows.push_back(row);
  }
  return trace;
}

TEST(PathMeasures, finds_gain_and_phase_of_a_lag_of_the_first_order) {
  const Trace trace = lagging(0.2);
  for (int axis = 0; axis < 3; ++axis) {
    const Bode sut = bode(trace, {}, axis);
    ASSERT_EQ(sut.gain.size(), multisine_hz(axis).size());
    for (std::size_t i = 0; i < sut.gain.size(); ++i) {
      const double x = 2 * kPi * sut.frequency_hz[i] * 0.2;
      EXPECT_NEAR(sut.gain[i], 1 / std::hypot(1, x), 1e-6);
      EXPECT_NEAR(sut.phase_deg[i], -std::atan(x) * 180 / kPi, 1e-4);
    }
  }
  EXPECT_NEAR(cutoff_hz(bode(trace, {}, 0)), 1 / (2 * kPi * 0.2), 0.03);
  EXPECT_EQ(quarter_hz(bode(trace, {}, 2)), multisine_hz(2).back());  // never: the sweep's end
  EXPECT_NEAR(lag_deg(trace, {0, 19.999}, 0, 0.05), std::atan(2 * kPi * 0.05 * 0.2) * 180 / kPi,
              1e-4);
}

TEST(PathMeasures, without_rows_say_nothing) {
  const Trace none;
  EXPECT_TRUE(std::isnan(mean_place_mm(none, {}, 0)));
  EXPECT_TRUE(std::isnan(fitness_kept(none, {})));
  EXPECT_TRUE(std::isnan(quarter_hz(bode(none, {}, 0))));
  EXPECT_EQ(frames_heard(none, {}), 0);
}

TEST(PathMeasures, tell_means_reach_and_the_fitness_that_is_left) {
  Trace trace;
  for (int i = 0; i < 100; ++i) {
    TraceRow row;
    row.time_s = i;
    row.target.translation = {0.01, 0, 0.5 + 0.001 * (i % 2)};
    row.error_m = {i % 2 == 0 ? 0.002 : -0.004, 0, 0};
    row.heard.frame = static_cast<std::uint64_t>(i + 1);
    row.heard.found = true;
    row.heard.fitness = i < 50 ? 0.8 : 0.6;
    trace.rows.push_back(row);
  }
  EXPECT_NEAR(mean_place_mm(trace, {}, 0), 10, 1e-9);
  EXPECT_NEAR(mean_absolute_error_mm(trace, {}, 0), 3, 1e-9);
  EXPECT_NEAR(distance_reach_mm(trace, {}).least_mm, 500, 1e-9);
  EXPECT_NEAR(distance_reach_mm(trace, {}).most_mm, 501, 1e-9);
  EXPECT_NEAR(fitness_kept(trace, {}), 0.75, 1e-9);
  EXPECT_NEAR(fitness_kept(trace, {0, 40}), 1, 1e-9);
  EXPECT_EQ(frames_heard(trace, {10, 19}), 10);
}

}  // namespace
}  // namespace gannet::world
