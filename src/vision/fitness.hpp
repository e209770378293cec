// Fitness: how well images agree with a target at a hypothesis. It scores batches: one virtual call
// for a batch, none per pixel. Kinds (fitness_kinds.hpp): p001, p002 (photo-model), p000 (Pb3DP),
// gannet (correlation, both). A Fitness holds its target; score() is const and may be called from
// several workers at once, each with its own Scratch. score() is RT safe.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "src/vision/hypothesis.hpp"
#include "src/vision/point_set.hpp"
#include "src/vision/prepared_frame.hpp"

namespace gannet::vision {

// Addresses of one candidate's points: one for each worker.
struct Scratch {
  explicit Scratch(int max_points)
      : index(static_cast<std::size_t>(padded(max_points) + 2 * kLanes)) {}
  std::vector<std::int32_t> index;
};

// A target as the fitnesses see it: points per level. unscaled: x and y are ray coordinates of the
// left camera (Pb3DP, right image only), not metres on the plane.
struct TargetPoints {
  std::array<PointSet, kLevels> level;
  int levels = 1;
  std::uint8_t background_hue = 0;
  bool unscaled = false;

  // Relative cost of scoring at a level: 1 at level 0.
  double cost(int at) const;
};

class Fitness {
 public:
  virtual ~Fitness() = default;

  virtual PlaneNeeds needs() const = 0;
  // Levels of detail that it can score at: 1, or as many as the target has.
  virtual int levels(const TargetPoints& target) const = 0;
  // Larger is better. scores.size() == hypotheses.size().
  virtual void score(const TargetPoints& target, const PreparedFrame& frame, int level,
                     std::span<const Hypothesis> hypotheses, std::span<float> scores,
                     Scratch& scratch) const = 0;
  // What the eye that agrees less gives to the score of one hypothesis, at level 0; for a rectangle
  // of the left image the score itself.
  virtual float weaker_eye(const TargetPoints& target, const PreparedFrame& frame,
                           const Hypothesis& hypothesis, Scratch& scratch) const = 0;
};

}  // namespace gannet::vision
