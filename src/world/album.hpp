// Album: the model database of P001 Fig. 5 made from this world's pictures: six creatures, each
// photographed from its left and its right side (the same picture, mirrored), twelve models; and
// pairs of pictures of one of them each, with what is truly in view, to search the database with.
// Start-up only.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/base/parallel.hpp"
#include "platform/base/result.hpp"
#include "src/world/scenario.hpp"

namespace gannet::world {

// Targets: the twelve, and behind them two creatures that are in no model (known = false).
// Where the photographs are absent all are drawn.
Scenario album_scenario();

struct Album {
  std::vector<std::string> notes;  // what is a stand-in or drawn, a line each
  int models = 0;
};

// Writes FOLDER/rig.toml, FOLDER/models/NAME.gannet and, with pairs > 0, FOLDER/pairs/left/*.png,
// FOLDER/pairs/right/*.png and FOLDER/pairs/truth.csv (frame,model,lux,x_m,y_m,z_m): each in turn,
// and then none, at a pose chosen at random, where both eyes see all of it, before the two others,
// in pool water at 400, 50 or 5 lx. Same seed, same files. Error: a file cannot be written.
Result<Album> make_album(const std::string& folder, const std::string& assets, int pairs,
                         std::uint64_t seed, Parallel& parallel);

}  // namespace gannet::world
