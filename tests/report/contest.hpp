// Contest: each method is shown the same single pair of images and has to find the target from
// nothing, with the same number of evaluations. Report only; run() spreads trials over the Parallel
// it is given, and the answer does not depend on that.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "tests/report/studio.hpp"

namespace gannet::robustness {

struct Method {
  const char* name;
  const char* optimiser;
  const char* fitness;
};
// Ours first, then the search of the papers with their fitness.
inline constexpr std::array<Method, 2> kMethods = {
    {{"gannet", "gannet", "gannet"}, {"rm_ga + p002", "rm_ga", "p002"}}};

// A pose is right within these, as in the acquisition benchmark.
inline constexpr double kSide_mm = 10, kDepth_mm = 20, kAngle_deg = 10;

bool is_right(const Pose& found, const Pose& truth);

struct Outcome {
  bool right = false;  // the pose; whether or not the method itself trusts it
  bool trusted = false;
  double side_mm = 0, depth_mm = 0, angle_deg = 0;  // errors: across the axis, along it, of turn
};

struct Cell {
  std::array<std::vector<Outcome>, kMethods.size()> trials;
};

struct Contest {
  int trials = 15;  // a cell
  int evaluations = 20000;
  std::uint64_t seed = 1;
};

// All cells of the planes, plane by plane. done(n): n trials are over; on the caller's thread.
Result<std::vector<std::vector<Cell>>> run(const Contest& contest, const Cast& cast,
                                           std::span<const Plane> planes, Parallel& parallel,
                                           const std::function<void(long)>& done);

// The share that is right counts, the medians are of those.
struct Score {
  int trials = 0, right = 0, trusted_wrong = 0;
  double side_mm, depth_mm, angle_deg;  // medians; NaN where none is right
};
Score score_of(std::span<const Outcome> outcomes);

}  // namespace gannet::robustness
