#include "src/world/motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "platform/base/random.hpp"

namespace gannet::world {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kDegree = kPi / 180;

Eigen::Vector3d metres(const std::vector<double>& mm) {
  return Eigen::Vector3d(mm[0], mm[1], mm[2]) / 1000;
}

}  // namespace

Motion::Motion(const MotionConfig& config, std::uint64_t seed) : config_(config) {
  if (config_.kind == "p001") {
    // P001 §4: x and y by 100 mm in 20 s, z by 100 mm in 60 s; y a quarter ahead of x, so that the
    // target goes round instead of along a line.
    const MotionConfig published;
    config_.amplitude_mm = published.amplitude_mm;
    config_.period_s = published.period_s;
    config_.phase_deg = published.phase_deg;
  }
  if (config_.kind == "p001" || config_.kind == "sine") add_periodic();
  if (config_.kind == "random") add_random(seed);
  if (config_.kind == "multisine") add_multisine();
}

void Motion::add_periodic() {
  for (std::size_t i = 0; i < 3; ++i) {
    const double rate = 2 * kPi / config_.period_s[i];
    sines_[i].push_back({config_.amplitude_mm[i] / 1000, rate, config_.phase_deg[i] * kDegree});
    sines_[i + 3].push_back({config_.turn_deg[i] * kDegree, rate, config_.phase_deg[i] * kDegree});
  }
}

void Motion::add_random(std::uint64_t seed) {
  // Eight sines of random rate and phase up to the bandwidth; their amplitudes add up to the one
  // that was asked for, which is therefore never exceeded.
  constexpr int kSines = 8;
  Random random(seed);
  for (std::size_t axis = 0; axis < 6; ++axis) {
    const double amplitude =
        axis < 3 ? config_.amplitude_mm[axis] / 1000 : config_.turn_deg[axis - 3] * kDegree;
    for (int i = 0; i < kSines; ++i) {
      const double rate = 2 * kPi * config_.bandwidth_hz * (0.1 + 0.9 * random.uniform());
      sines_[axis].push_back({amplitude / kSines, rate, 2 * kPi * random.uniform()});
    }
  }
}

void Motion::add_multisine() {
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const std::span<const double> frequencies = multisine_hz(axis);
    const auto count = static_cast<double>(frequencies.size());
    double k = 0;
    for (const double frequency_hz : frequencies) {
      const double rate = 2 * kPi * frequency_hz;
      // Schroeder's phases (IEEE Trans. Inf. Theory 16, 1970) keep the peaks of the sum low.
      const double phase = -kPi * k * (k + 1) / count;
      const double by_acceleration = config_.sine_acceleration_mm_s2 / (rate * rate);
      sines_[i].push_back({std::min(config_.amplitude_mm[i], by_acceleration) / 1000, rate, phase});
      ++k;
    }
  }
}

std::span<const double> multisine_hz(int axis) {
  static constexpr double kX[] = {0.05, 0.20, 0.35, 0.55, 0.85, 1.15, 1.55, 2.05, 2.65};
  static constexpr double kY[] = {0.10, 0.25, 0.40, 0.65, 0.95, 1.25, 1.75, 2.15, 2.85};
  static constexpr double kZ[] = {0.15, 0.30, 0.45, 0.70, 1.00, 1.35, 1.85, 2.35, 3.00};
  return axis == 0 ? std::span(kX) : axis == 1 ? std::span(kY) : std::span(kZ);
}

double Motion::sum(std::size_t axis, double time_s) const {
  double total = 0;
  for (const Sine& sine : sines_[axis])
    total += sine.amplitude * std::sin(sine.rate_rad_s * time_s + sine.phase_rad);
  return total;
}

Eigen::Vector3d Motion::along_waypoints(double time_s) const {
  const auto& points = config_.waypoints;
  if (points.empty()) return Eigen::Vector3d::Zero();
  if (time_s <= points.front().at_s) return metres(points.front().position_mm);
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (time_s >= points[i].at_s) continue;
    // Starts and ends each leg at rest.
    const double share = (time_s - points[i - 1].at_s) / (points[i].at_s - points[i - 1].at_s);
    const double eased = 0.5 - 0.5 * std::cos(kPi * share);
    return (1 - eased) * metres(points[i - 1].position_mm) + eased * metres(points[i].position_mm);
  }
  return metres(points.back().position_mm);
}

Transform<Target, Target> Motion::at(double time_s) const {
  const double t = std::max(0.0, time_s - config_.start_s);
  Transform<Target, Target> moved;
  if (config_.kind == "waypoints") {
    moved.translation = along_waypoints(t);
    return moved;
  }
  moved.translation = {sum(0, t), sum(1, t), sum(2, t)};
  moved.rotation = quaternion_from_rotation_vector({sum(3, t), sum(4, t), sum(5, t)});
  return moved;
}

void describe(Visitor& v, Waypoint& c) {
  v.field("at_s", c.at_s, {.min = 0, .unit = "s", .help = "When it is there."});
  v.field("position_mm", c.position_mm,
          {.size = 3, .unit = "mm", .help = "Where, from the resting place."});
}

void describe(Visitor& v, MotionConfig& c) {
  v.field(
      "kind", c.kind,
      {.choices = {"still", "p001", "sine", "random", "multisine", "waypoints"},
       .help = "How the target moves about its resting place; p001: as in that paper's "
               "tracking experiment; multisine: nine sines from 0.05 to 3 Hz along each axis."});
  v.field("amplitude_mm", c.amplitude_mm,
          {.size = 3,
           .unit = "mm",
           .help = "Of x, y, z; for random the most that can be; of multisine's slow "
                   "sines, 0 for an axis at rest."});
  v.field("period_s", c.period_s,
          {.min = 0.1, .size = 3, .unit = "s", .help = "Of x, y, z and of the turns about them."});
  v.field("phase_deg", c.phase_deg, {.size = 3, .unit = "°", .help = "Of x, y, z at the start."});
  v.field("turn_deg", c.turn_deg,
          {.min = -80, .max = 80, .size = 3, .unit = "°", .help = "Turning about x, y, z."});
  v.field("bandwidth_hz", c.bandwidth_hz,
          {.min = 0.001, .max = 10, .unit = "Hz", .help = "Highest frequency of random."});
  v.field("sine_acceleration_mm_s2", c.sine_acceleration_mm_s2,
          {.min = 0.1, .max = 1e5, .unit = "mm/s²", .help = "Of multisine's quick sines, each."});
  v.field("start_s", c.start_s, {.min = 0, .unit = "s", .help = "The motion's clock starts then."});
  v.list("waypoint", c.waypoints, "A place and a time each, in order of time.");
}

}  // namespace gannet::world
