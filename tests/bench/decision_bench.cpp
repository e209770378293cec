// Found or not: false finds in scenes without the target, detection in scenes with it, single
// frames from nothing.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "src/track/recogniser.hpp"
#include "src/track/track_config.hpp"
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

// What the decision looks at, as the recogniser adds it up.
double sureness(const track::Recognition& got) {
  return got.likeness + 0.5 * std::max(0.0, got.coarse_fitness - std::max(0.0, got.rival_fitness));
}

// How often wrong poses exceed `limit`, by the exponential that the highest tenth of them follows.
double tail_beyond(std::vector<double> wrong, double limit) {
  std::sort(wrong.begin(), wrong.end());
  const std::size_t count = wrong.size() / 10;
  if (count < 10) return std::numeric_limits<double>::quiet_NaN();
  const double from = wrong[wrong.size() - count - 1];
  double mean = 0;
  for (std::size_t i = wrong.size() - count; i < wrong.size(); ++i)
    mean += (wrong[i] - from) / static_cast<double>(count);
  return 0.1 * std::exp(-(limit - from) / mean);
}

void add_tail(std::vector<double> wrong, Results& results) {
  constexpr double kFramesAnHour = 30 * 3600;
  const double limit = track::TrackConfig{}.found_likeness;
  const double highest = *std::max_element(wrong.begin(), wrong.end());
  const double an_hour = kFramesAnHour * tail_beyond(wrong, limit);
  char note[120];
  std::snprintf(note, sizeof note,
                "at %.2f; the highest of these is %.3f; a lock needs %d in a row", limit, highest,
                track::TrackConfig{}.lock_frames);
  results.add({"false finds an hour by the tail, 30 Hz",
               "",
               {an_hour, an_hour, an_hour},
               static_cast<int>(wrong.size()),
               {},
               note});
}

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
  std::vector<double> wrong;
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
      if (!is_target) wrong.push_back(sureness(got));
      tally.right += got.found && is_target &&
                     is_right(got.left_from_target, seen.pair.truth, scene.size_m(target));
    }
  }
  add_row("false finds, target absent", absent.found, absent.trials, results);
  if (!wrong.empty()) add_tail(wrong, results);
  add_row("found and right, good light", good.right, good.trials, results);
  add_row("found but wrong, good light", good.found - good.right, good.trials, results);
  add_row("found and right, murky or dark", poor.right, poor.trials, results);
  add_row("found but wrong, murky or dark", poor.found - poor.right, poor.trials, results);
}

}  // namespace gannet::bench
