// The recogniser's and tracker's parameters, described once. Start-up only.
#pragma once

#include <string>

#include "platform/base/describe.hpp"
#include "src/search/search_config.hpp"

namespace gannet::track {

struct TrackConfig {
  std::string fitness = "gannet";    // p001 | p002 | p000 | gannet
  std::string optimiser = "gannet";  // rm_ga | differential_evolution | cma_es | gannet
  int evaluations = 20000;           // full stereo evaluations from nothing
  int evaluations_tracking = 2000;   // while locked, where the quick way fails
  int watch_candidates = 160;        // coarse, a frame, while locked: the global check
  bool refine = true;  // below a pixel; false: as in the papers, the pose is the search's own
  int seed = 1;
  int model_points = 800;  // wanted S_in points of a model
  // Least likeness of a model (vision/likeness.hpp) plus half its lead over the best place
  // elsewhere that counts as found: its tail over wrong poses is in `make bench`, "found or not".
  double found_likeness = 0.55;
  // The same for a rectangle: least correlation plus lead over the best depth elsewhere.
  double found_fitness = 0.55;
  bool relief = true;
  double found_votes = 0.3;  // for vote fitnesses: least share of a perfect score
  double z_min_m = 0.4;
  double z_max_m = 1.0;
  double half_width_x_m = 0;  // 0: the common field of view
  double half_width_y_m = 0;
  double tilt_deg = 40;
  double roll_deg = 45;
  double coast_s = 0.5;         // locked → coasting → lost after this long unseen
  int lock_frames = 2;          // consecutive finds before locked
  double jump_m = 0.2;          // farther from the prediction: doubted
  search::SearchConfig search;  // described beside this one, as group "search"
};

void describe(Visitor& v, TrackConfig& c);

}  // namespace gannet::track
