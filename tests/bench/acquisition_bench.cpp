// One-frame acquisition: how often a search from nothing finds the pose, by evaluations.
#include "src/track/recogniser.hpp"
#include "tests/bench/benches.hpp"
#include "tests/bench/cluttered_scene.hpp"

namespace gannet::bench {
namespace {

bool is_right(const Pose& found, const Pose& truth) {
  const Eigen::Vector3d d = found.translation - truth.translation;
  const double turn =
      rotation_vector_from_quaternion(canonical(found.rotation * truth.rotation.conjugate()))
          .norm();
  return std::abs(d.x()) < 0.01 && std::abs(d.y()) < 0.01 && std::abs(d.z()) < 0.02 &&
         turn < 10 * 3.14159265358979 / 180;
}

struct Scene {
  std::unique_ptr<vision::PreparedFrame> frame;
  Pose truth;
};

struct Method {
  const char* name;
  const char* optimiser;
  const char* fitness;
  int goal_evaluations = 0;  // of these, all but one scene in a hundred within a frame's time
};
constexpr Method kMethods[] = {{"gannet", "gannet", "gannet", 6000},
                               {"differential_evolution", "differential_evolution", "gannet"},
                               {"cma_es", "cma_es", "gannet"},
                               {"rm_ga", "rm_ga", "gannet"},
                               {"rm_ga with p002 (the papers)", "rm_ga", "p002"}};

void bench_method(const Method& method, const ClutteredScene& scene,
                  const std::vector<Scene>& scenes, Results& results) {
  track::TrackConfig config;
  config.optimiser = method.optimiser;
  config.fitness = method.fitness;
  const auto sut =
      track::Recogniser::create(config, scene.rig(), track::TargetKind::kModel).value();
  const vision::PatchModel model = scene.model(400);
  Serial serial;
  for (const int evaluations : {540, 2000, 6000, 20000}) {
    int right = 0;
    std::vector<double> ms;
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      sut->set_model(model);  // forgets the scene before
      const double start = thread_cpu_ns();
      const track::Recognition got = sut->recognise(
          *scenes[i].frame, nullptr, {.evaluations = static_cast<double>(evaluations)}, serial);
      ms.push_back((thread_cpu_ns() - start) / 1e6);
      right += is_right(got.left_from_target, scenes[i].truth);
    }
    const int n = static_cast<int>(scenes.size());
    char note[100];
    std::snprintf(note, sizeof note, "%d of %d; %.1f ms median", right, n, quantile(ms, 0.5));
    std::vector<Goal> goals;
    if (evaluations == method.goal_evaluations)
      goals = {at_least(99, "% right", 100.0 * right / n), at_most(33, "ms", quantile(ms, 0.5))};
    results.add({std::string(method.name) + ", " + std::to_string(evaluations) + " evaluations",
                 "% right, Wilson 95 %",
                 wilson_percent(right, n),
                 n,
                 {},
                 note,
                 goals});
  }
}

}  // namespace

void bench_acquisition(const Options& options, Results& results) {
  if (options.quick) return;
  results.group(
      "one-frame acquisition",
      "Share of random cluttered scenes (flat target 160 x 110 mm, three others of its kind behind "
      "it, textured ground, noise of 3 grey levels) found from nothing in one frame: within 10 mm "
      "in x and y, 20 mm in z and 10 degrees, after the refinement, which all have. Search: common "
      "field of view, z 0.4 to 1.0 m, tilts 40, roll 45 degrees. Brackets: 95 % interval.");
  const ClutteredScene scene(options.width(), options.height());
  std::vector<Scene> scenes;
  Random random(2024);
  for (int i = 0; i < options.scenes; ++i) {
    const Pair pair = scene.see(scene.random_pose(random), static_cast<std::uint64_t>(100 + i));
    auto frame = std::make_unique<vision::PreparedFrame>(
        options.width(), options.height(), vision::PlaneNeeds{.packed = true, .hue_value = true});
    frame->prepare(pair.left.view(), pair.right.view());
    scenes.push_back({std::move(frame), pair.truth});
  }
  for (const Method& method : kMethods) bench_method(method, scene, scenes, results);
}

}  // namespace gannet::bench
