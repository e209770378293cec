// Workload: what the kernels and fitnesses are given in life: prepared frames, a target's points
// and the candidate poses of a real search, every k-th that it proposed. Benchmarks only, one
// thread.
#pragma once

#include <memory>
#include <vector>

#include "src/track/recogniser.hpp"
#include "src/vision/hypothesis.hpp"
#include "tests/bench/cluttered_scene.hpp"

namespace gannet::bench {

constexpr int kTurnCandidates = 16;  // scored by each contender in one turn

// One eye's view of one candidate and the cells that it samples.
struct EyeCells {
  vision::PlaneView view;
  int visible = 0;
  std::vector<std::int32_t> index;
};

struct Workload {
  StereoRig rig;
  std::unique_ptr<vision::PreparedFrame> frame;
  std::unique_ptr<track::Recogniser> recogniser;  // holds the points
  std::vector<vision::Hypothesis> candidates;
  std::vector<Pose> poses;            // the same
  std::vector<EyeCells> left, right;  // the same; left empty for rectangles
  const vision::TargetPoints& target() const { return recogniser->target(); }
  const vision::PointSet& points() const { return recogniser->target().level[0]; }
  double eyes() const { return left.empty() ? 1 : 2; }
  // The candidates of a turn: they move on, so that caches and predictors see what life shows them.
  std::size_t first(int turn) const {
    return static_cast<std::size_t>(turn) * kTurnCandidates % candidates.size();
  }
};

// A photo-model of about so many points on the target; brown: both lenses distort.
Workload model_workload(const ClutteredScene& scene, int inside_points, int candidates, bool brown);
// The rectangle of Pb3DP on the target, seen by the right eye.
Workload rectangle_workload(const ClutteredScene& scene, int candidates);

}  // namespace gannet::bench
