// Fitness maps: how each model's fitness is distributed over x and y (P001 §2.5, Fig. 6): the
// target at [0, 0, 500] mm of Σ_H, alone and among other creatures, scored every 5 mm with depth
// and orientation true, by the default fitness and by the paper's. Start-up only.
#pragma once

#include <string>
#include <vector>

#include "platform/base/parallel.hpp"
#include "platform/base/result.hpp"

namespace gannet::world {

struct FitnessMap {
  std::string model, fitness;
  bool among_others = false;
  int width = 0, height = 0;   // cells; the middle one is the truth
  std::vector<double> scores;  // row by row, y downwards
};

inline constexpr double kMapStep_mm = 5;

// What a map says about its target.
struct MapPeak {
  double off_mm = 0;     // from the truth to the highest cell
  double score = 0;      // there
  double elsewhere = 0;  // the highest that is farther than 50 mm from the truth
};
MapPeak peak_of(const FitnessMap& map);

// Writes FOLDER/maps.html, a page with all maps as pictures, and FOLDER/maps.csv, the peaks; the
// models are FOLDER/models/*.gannet, which make_album has written. Same seed, same files. Returns
// the maps. Error: a file cannot be read or written.
Result<std::vector<FitnessMap>> make_fitness_maps(const std::string& folder,
                                                  const std::string& assets, std::uint64_t seed,
                                                  Parallel& parallel);

}  // namespace gannet::world
