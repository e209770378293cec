// Motion: where a target is about its resting place as time goes on: still, P001's path, sines,
// band-limited random, many sines at once (a frequency response by one run), waypoints. Position
// and a small turn (rotation vector), both in the resting target's own axes. Pure; the same seed
// gives the same path. Any thread.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "platform/base/describe.hpp"
#include "src/core/transform.hpp"

namespace gannet::world {

struct Waypoint {
  double at_s = 0;
  std::vector<double> position_mm = {0, 0, 0};
};

struct MotionConfig {
  std::string kind = "still";
  std::vector<double> amplitude_mm = {100, 100, 100};
  std::vector<double> period_s = {20, 20, 60};
  std::vector<double> phase_deg = {0, 90, 0};
  std::vector<double> turn_deg = {0, 0, 0};
  double bandwidth_hz = 0.2;
  double sine_acceleration_mm_s2 = 60;
  double start_s = 0;
  std::vector<Waypoint> waypoints;
};

void describe(Visitor& v, Waypoint& c);
void describe(Visitor& v, MotionConfig& c);

// The frequencies of kind multisine along an axis (0 x, 1 y, 2 z), rising: whole multiples of one
// over its period, and no two axes share one, so that one run tells them all apart.
inline constexpr double kMultisinePeriod_s = 20;
std::span<const double> multisine_hz(int axis);

class Motion {
 public:
  Motion(const MotionConfig& config, std::uint64_t seed);
  // The moved target seen from its resting place: translation m, rotation. Before start_s, and
  // for "still", it rests.
  Transform<Target, Target> at(double time_s) const;

 private:
  // A sum of sines for each of x, y, z and the three turns.
  struct Sine {
    double amplitude = 0;  // m or rad
    double rate_rad_s = 0;
    double phase_rad = 0;
  };
  void add_periodic();
  void add_random(std::uint64_t seed);
  void add_multisine();
  Eigen::Vector3d along_waypoints(double time_s) const;
  double sum(std::size_t axis, double time_s) const;

  MotionConfig config_;
  std::vector<Sine> sines_[6];
};

}  // namespace gannet::world
