#include "src/vision/fitness_kinds.hpp"

#include "src/vision/correlation_fitness.hpp"
#include "src/vision/photo_model_fitness.hpp"
#include "src/vision/projection_fitness.hpp"

namespace gannet::vision {
namespace {

struct Kind {
  std::string_view name;
  bool scores_models;
  bool scores_rectangles;
  std::unique_ptr<Fitness> (*make)(const StereoRig& rig, const Kernels& kernels, bool unscaled);
};

template <VoteRule kRule>
std::unique_ptr<Fitness> make_votes(const StereoRig& rig, const Kernels& kernels, bool) {
  return std::make_unique<PhotoModelFitness>(rig, kernels, kRule);
}

// A rectangle is compared with itself as the other eye sees it a moment's exposure apart: faint
// texture counts, where against an old photo it would be noise.
CorrelationOptions rectangle_options() {
  CorrelationOptions options;
  options.floor_y = options.floor_uv = 0.7f;
  options.weight_y = options.weight_uv = 3;
  return options;
}

// A new fitness is a line here.
constexpr Kind kKinds[] = {
    {"p001", true, false, make_votes<VoteRule::kP001>},
    {"p002", true, false, make_votes<VoteRule::kP002>},
    {"p000", false, true,
     [](const StereoRig& rig, const Kernels& kernels, bool) -> std::unique_ptr<Fitness> {
       return std::make_unique<ProjectionFitness>(rig, kernels);
     }},
    {"gannet", true, true,
     [](const StereoRig& rig, const Kernels& kernels, bool unscaled) -> std::unique_ptr<Fitness> {
       return std::make_unique<CorrelationFitness>(
           rig, kernels, unscaled ? rectangle_options() : CorrelationOptions{});
     }},
};

}  // namespace

Result<std::unique_ptr<Fitness>> make_fitness(std::string_view name, bool unscaled,
                                              const StereoRig& rig, const Kernels& kernels) {
  std::string fitting;
  bool known = false;
  for (const Kind& kind : kKinds) {
    const bool fits = unscaled ? kind.scores_rectangles : kind.scores_models;
    if (kind.name == name && fits) return kind.make(rig, kernels, unscaled);
    known = known || kind.name == name;
    if (fits) fitting += (fitting.empty() ? "" : ", ") + std::string(kind.name);
  }
  const std::string what = unscaled ? "a rectangle" : "a model";
  return Error{known ? "fitness \"" + std::string(name) + "\" cannot score " + what +
                           "; those that can: " + fitting
                     : "unknown fitness \"" + std::string(name) + "\"; for " + what +
                           " there are " + fitting};
}

std::vector<std::string> fitness_names() {
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) names.emplace_back(kind.name);
  return names;
}

}  // namespace gannet::vision
