// Found or not: false finds in scenes without the target, detection in scenes with it, single
// frames from nothing.
#include <array>
#include <cstdio>

#include "src/track/recogniser.hpp"
#include "tests/bench/benches.hpp"
#include "tests/bench/photo_scene.hpp"

namespace gannet::bench {
namespace {

// The papers' allowance: a third of the target's size in x and y, 50 mm in z.
bool is_right(const Pose& got, const Pose& truth, const Eigen::Vector2d& size_m) {
  const Eigen::Vector3d error = got.translation - truth.translation;
  return std::abs(error.x()) <= size_m.x() / 3 && std::abs(error.y()) <= size_m.y() / 3 &&
         std::abs(error.z()) <= 0.05;
}

struct Tally {
  int trials = 0, found = 0, right = 0;
};

void add_row(const char* name, int count, int trials, Results& results) {
  if (trials == 0) return;
  char note[40];
  std::snprintf(note, sizeof note, "%d of %d", count, trials);
  results.add({name, "%, Wilson 95 %", wilson_percent(count, trials), trials, {}, note});
}

}  // namespace

void bench_decision(const Options& options, Results& results) {
  if (options.quick) return;
  PhotoScene scene(options.width(), options.height());
  results.group(
      "found or not",
      std::string("Random scenes of ") +
          (scene.has_photographs() ? "photographed creatures" : "drawn pictures") +
          " over three grounds, in air or three waters, 5 to 400 lx, things behind the target. A "
          "search from nothing for each creature: one that is there, and those that are not. "
          "Photos were taken in air at 400 lx. Right: within the papers' allowance. Good light: "
          "air or pool water, 50 lx and more.");
  const auto sut = track::Recogniser::create({}, scene.rig(), track::TargetKind::kModel).value();
  vision::PreparedFrame frame(options.width(), options.height(), sut->needs());
  Serial serial;
  Tally absent, good, poor;
  for (int i = 0; i < options.scenes; ++i) {
    const int target = i % scene.targets();
    const PhotoScene::Seen seen = scene.see(static_cast<std::uint64_t>(i), target);
    frame.prepare(seen.pair.left.view(), seen.pair.right.view());
    for (int sought = 0; sought < scene.targets(); ++sought) {
      const bool is_target = sought == target;
      if (!is_target && seen.present[static_cast<std::size_t>(sought)]) continue;
      sut->set_model(scene.model(sought));
      const track::Recognition got = sut->recognise(frame, nullptr, {}, serial);
      Tally& tally = !is_target ? absent : seen.good_light ? good : poor;
      ++tally.trials;
      tally.found += got.found;
      tally.right += got.found && is_target &&
                     is_right(got.left_from_target, seen.pair.truth, scene.size_m(target));
    }
  }
  add_row("false finds, target absent", absent.found, absent.trials, results);
  add_row("found and right, good light", good.right, good.trials, results);
  add_row("found but wrong, good light", good.found - good.right, good.trials, results);
  add_row("found and right, murky or dark", poor.right, poor.trials, results);
  add_row("found but wrong, murky or dark", poor.found - poor.right, poor.trials, results);
}

}  // namespace gannet::bench
