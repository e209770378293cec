// Props: the pictures of a scenario as textures, and the photo-models of its known targets, made
// as a user makes them: a photo at 400 mm (farther for what does not fit), in air under good light,
// cut out by mask and background. Start-up only.
#pragma once

#include <string>
#include <vector>

#include "platform/base/parallel.hpp"
#include "platform/base/result.hpp"
#include "src/world/renderer.hpp"
#include "src/world/scenario.hpp"
#include "src/world/stage.hpp"

namespace gannet::world {

struct Pictures {
  std::vector<Texture> textures;
  StageTextures places;
  std::vector<std::string> notes;  // what is a stand-in or drawn, a line each
};

// assets: the folder of photographs; where one is absent a drawn picture takes its place, with a
// note. Error: a texture that nobody knows.
Result<Pictures> gather_pictures(const Scenario& scenario, const std::string& assets);

// Writes <folder>/<name>.gannet for each known target and returns the paths in their order.
Result<std::vector<std::string>> make_models(const Scenario& scenario, const StageTextures& places,
                                             Renderer& renderer, Parallel& parallel,
                                             const std::string& folder);

}  // namespace gannet::world
