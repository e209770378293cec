// What a relief is worth: a dome, tracked with and without one on the same images, and what it
// costs.
#include <array>
#include <cmath>

#include "src/track/target_tracker.hpp"
#include "src/track/track_config.hpp"
#include "tests/bench/benches.hpp"
#include "tests/support/flat_scene.hpp"

namespace gannet::bench {
namespace {

using Pose = Transform<LeftCamera, Target>;

struct Views {
  std::vector<Pose> truth;
  std::vector<test::Picture> left, right;
};

// A closed path, so that it can be gone round and round.
Views views_of(const test::FlatScene& scene, int frames) {
  Views out;
  for (int i = 0; i < frames; ++i) {
    const double t = 6.2832 * i / frames;
    out.truth.push_back(test::pose_at(0.06 + 0.04 * std::sin(t), 0.03 * std::cos(t),
                                      0.6 + 0.04 * std::sin(t), 15 * std::cos(t), 15 * std::sin(t),
                                      12 * std::sin(2 * t)));
    const auto seed = static_cast<std::uint64_t>(2 * i + 1);
    out.left.push_back(scene.see(true, &out.truth.back(), seed));
    out.right.push_back(scene.see(false, &out.truth.back(), seed + 1));
  }
  return out;
}

struct Errors {
  std::vector<double> xy_mm, z_mm, angle_deg, spent_ms;
  int locked = 0;
};

void add_frame(track::TargetTracker& sut, const Views& views, int turn, bool counts, Errors& out) {
  const auto at = static_cast<std::size_t>(turn) % views.truth.size();
  Serial serial;
  const double start = thread_cpu_ns();
  const PoseEstimate got = sut.process(views.left[at].view(), views.right[at].view(),
                                       time_from_ns(33'000'000LL * (turn + 1)),
                                       static_cast<std::uint64_t>(turn) + 1, {}, serial);
  const double spent = thread_cpu_ns() - start;
  if (!counts || got.state != TrackState::kLocked) return;
  const Eigen::Vector3d error = got.left_from_target.translation - views.truth[at].translation;
  out.xy_mm.push_back(1e3 * error.head<2>().norm());
  out.z_mm.push_back(1e3 * std::abs(error.z()));
  out.angle_deg.push_back(57.29578 *
                          got.left_from_target.rotation.angularDistance(views.truth[at].rotation));
  out.spent_ms.push_back(spent / 1e6);
  ++out.locked;
}

}  // namespace

void bench_relief(const Options& options, Results& results) {
  results.group(
      "relief",
      "A textured dome of 160 x 110 mm and the height told, tracked on a path of 45 views "
      "at 0.6 m, noise 1 grey level; with the relief that is learned meanwhile and "
      "without, by turns on the same images. Errors of the last round, ratios frame by frame.");
  const int frames = options.quick ? 6 : 45, rounds = options.quick ? 2 : 14;
  for (const double bulge_mm : {0.0, 4.0, 8.0, 16.0}) {
    test::FlatScene scene;
    for (Intrinsics* camera : {&scene.rig.left, &scene.rig.right}) {
      camera->width = options.width();
      camera->height = options.height();
      camera->fx = camera->fy = options.width();
      camera->cx = (camera->width - 1) / 2.0;
      camera->cy = (camera->height - 1) / 2.0;
    }
    scene.bulge_m = 1e-3 * bulge_mm;
    const Views views = views_of(scene, frames);
    std::array<Errors, 2> errors;
    std::array<std::unique_ptr<track::TargetTracker>, 2> suts;
    track::TrackConfig config;
    for (const bool with : {false, true}) {
      config.relief = with;
      suts[with] = track::TargetTracker::create(config, scene.rig,
                                                {scene.model(config.model_points).value()})
                       .value();
      suts[with]->choose_model(0, 1);
    }
    for (int turn = 0; turn < frames * rounds; ++turn) {
      const bool counts = turn >= frames * (rounds - 1);
      for (const bool with : {false, true})
        add_frame(*suts[with], views, turn, counts, errors[with]);
    }
    const std::string name = "dome of " + std::to_string(static_cast<int>(bulge_mm)) + " mm";
    const auto add = [&](const char* what, const char* unit, std::vector<double> Errors::*of) {
      const auto& without = errors[0].*of;
      const auto& with = errors[1].*of;
      if (with.empty() || with.size() != without.size()) return;  // not locked in the same frames
      results.add({name + ", " + what,
                   unit,
                   spread_of(with),
                   errors[1].locked,
                   {{"times that of the flat model", spread_of(ratios_of(with, without))}},
                   "flat: " + std::to_string(spread_of(without).median) + " " + unit});
    };
    add("error of x and y", "mm", &Errors::xy_mm);
    add("error of z", "mm", &Errors::z_mm);
    add("error of the attitude", "deg", &Errors::angle_deg);
    add("thread CPU time of a frame", "ms", &Errors::spent_ms);
  }
}

}  // namespace gannet::bench
