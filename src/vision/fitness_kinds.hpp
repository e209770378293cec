// The kinds of fitness, by the names that configs and command lines use. Start-up only.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "platform/base/result.hpp"
#include "src/vision/fitness.hpp"

namespace gannet::vision {

// unscaled: for a rectangle of the live image (Pb3DP), else for a photo-model. Error: unknown name,
// or one that cannot score such a target; the names that can are listed.
Result<std::unique_ptr<Fitness>> make_fitness(std::string_view name, bool unscaled,
                                              const StereoRig& rig, const Kernels& kernels);

std::vector<std::string> fitness_names();

}  // namespace gannet::vision
