// PaperFrames: experiments on single frames: pairs of a still scene, each with its own noise, are
// recognised without daemon, filter or vehicle: by the photo-model of a target that the scenario
// has as known, else by its rectangle in the left image (Pb3DP). Our method starts anew in each
// pair; the papers' population goes on from frame to frame, as theirs did, and its first 90 frames
// (3 s) do not count. World's thread alone.
#pragma once

#include <span>
#include <vector>

#include "src/track/recognition.hpp"
#include "src/world/paper_run.hpp"

namespace gannet::world {

// One pair's answer. Positions in Σ_H. Not found: the rest says where it would have been.
struct FrameSample {
  bool found = false;
  Eigen::Vector3d place_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d truth_m = Eigen::Vector3d::Zero();
  Eigen::Vector2d size_m = Eigen::Vector2d::Zero();       // of a rectangle, at the pose found
  Eigen::Vector2d true_size_m = Eigen::Vector2d::Zero();  // the same at the true pose
  double fitness = 0;
};

// Of the found samples, by the names that PaperTable uses; NaN: no such name, nothing found.
double frame_measure(std::string_view name, std::span<const FrameSample> samples);

Result<PaperResult> run_frames(const PaperRequest& request, const Scenario& scenario,
                               const PaperTick& tick);

}  // namespace gannet::world
