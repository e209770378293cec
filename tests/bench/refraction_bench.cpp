// What bent light costs: the same work with cameras in air, behind flat ports, with lenses that
// distort, and both.
#include <array>
#include <cmath>
#include <memory>

#include "src/track/target_tracker.hpp"
#include "src/vision/fitness_kinds.hpp"
#include "src/vision/kernel_choice.hpp"
#include "src/vision/refine.hpp"
#include "tests/bench/benches.hpp"
#include "tests/bench/cluttered_scene.hpp"
#include "tests/bench/workload.hpp"

namespace gannet::bench {
namespace {

constexpr Bend kBends[] = {Bend::kNothing, Bend::kPort, Bend::kLens, Bend::kPortAndLens};
constexpr const char* kNames[] = {"nothing bends light", "flat port", "Brown lens",
                                  "flat port and Brown lens"};

struct Sight {
  ClutteredScene scene;
  Workload work;
  std::vector<Pair> pairs;
};

std::vector<Sight> sights_of(const Options& options) {
  std::vector<Sight> out;
  const int frames = options.quick ? 2 : 8;
  for (const Bend bend : kBends) {
    ClutteredScene scene(options.width(), options.height(), bend);
    Workload work = model_workload(scene, 400, options.candidates(), false);
    if (!out.empty()) {  // the same poses for all
      work.candidates = out[0].work.candidates;
      work.poses = out[0].work.poses;
    }
    std::vector<Pair> pairs;
    for (int i = 0; i < frames; ++i) {
      const double t = 6.2832 * i / frames;
      pairs.push_back(
          scene.see(test::pose_at(0.06 + 0.015 * std::sin(t), 0.01 * std::cos(t),
                                  0.6 + 0.015 * std::sin(t), 3 * std::cos(t), 8, 4 * std::sin(t)),
                    5));
    }
    out.push_back({std::move(scene), std::move(work), std::move(pairs)});
  }
  return out;
}

void add_rows(const std::string& what, const std::string& unit, double per_ns,
              const std::vector<std::vector<double>>& times, int turns, const std::string& note,
              Results& results) {
  for (std::size_t i = 0; i < times.size(); ++i) {
    std::vector<double> scaled = times[i];
    for (double& t : scaled) t *= per_ns;
    Row row = {what + ", " + kNames[i], unit, spread_of(scaled), turns, {}, note};
    if (i > 0) {
      const Spread ratio = spread_of(ratios_of(times[i], times[0]));
      row.ratios = {{"times where nothing bends light", ratio}};
      row.goals = {at_most(1.15, row.ratios[0].text, ratio.median)};
    }
    results.add(row);
  }
}

void bench_search(std::vector<Sight>& sights, const Options& options, Results& results) {
  std::vector<std::unique_ptr<vision::Fitness>> fitnesses;
  std::vector<Contender> contenders;
  vision::Scratch scratch(track::Recogniser::max_points());
  std::array<float, kTurnCandidates> scores;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    fitnesses.push_back(
        vision::make_fitness("gannet", false, sights[i].work.rig, *vision::find_kernels("auto"))
            .value());
    contenders.push_back(
        {kNames[i], [&, work = &sights[i].work, f = fitnesses.back().get()](int turn) {
           f->score(work->target(), *work->frame, 0,
                    {work->candidates.data() + work->first(turn), kTurnCandidates}, scores,
                    scratch);
           consume(static_cast<double>(scores[0]));
           return kTurnCandidates;
         }});
  }
  const int turns = options.quick ? 3 : 201;
  add_rows("one evaluation", "us", 1e-3, interleave(contenders, turns), turns,
           std::to_string(sights[0].work.points().points()) + " points x 2 images", results);
}

void bench_refinement(std::vector<Sight>& sights, const Options& options, Results& results) {
  std::vector<std::unique_ptr<vision::RigOptics>> optics;
  std::vector<Contender> contenders;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    Workload& work = sights[i].work;
    work.frame->prepare(sights[i].pairs[0].left.view(), sights[i].pairs[0].right.view());
    optics.push_back(std::make_unique<vision::RigOptics>(work.rig));
    contenders.push_back({kNames[i], [&, w = &work, o = optics.back().get()](int data) {
                            Pose start = sights[0].pairs[0].truth;
                            start.translation +=
                                Eigen::Vector3d(1, -1, 2) * (1e-3 * (1 + data % 3));
                            const auto got =
                                vision::refine_pose(*o, w->points(), *w->frame, start, {});
                            consume(got.left_from_target.translation.z());
                            return 1.0;
                          }});
  }
  const int turns = options.quick ? 3 : 201;
  add_rows("refinement of one pose", "ms", 1e-6, interleave(contenders, turns), turns,
           "2 to 7 mm off", results);
}

void bench_locked(std::vector<Sight>& sights, const Options& options, Results& results) {
  const track::TrackConfig config;
  std::vector<std::unique_ptr<track::TargetTracker>> trackers;
  for (Sight& sight : sights) {
    trackers.push_back(track::TargetTracker::create(config, sight.scene.rig(),
                                                    {sight.scene.model(config.model_points)})
                           .value());
    trackers.back()->choose_model(0, 1);
  }
  Serial serial;
  std::vector<std::vector<double>> times(sights.size());
  double worst = 0;
  const int frames = options.quick ? 5 : 300;
  int locked = 0;
  for (int n = 0; n < frames + 3; ++n) {
    std::array<double, std::size(kBends)> spent = {};
    bool all = n >= 3;
    for (std::size_t i = 0; i < sights.size(); ++i) {
      const Pair& pair = sights[i].pairs[static_cast<std::size_t>(n) % sights[i].pairs.size()];
      const double start = thread_cpu_ns();
      const PoseEstimate got = trackers[i]->process(pair.left.view(), pair.right.view(),
                                                    time_from_ns(33'000'000LL * (n + 1)),
                                                    static_cast<std::uint64_t>(n) + 1, {}, serial);
      spent[i] = thread_cpu_ns() - start;
      all = all && got.state == TrackState::kLocked;
      if (all) {
        worst = std::max(worst, (got.left_from_target.translation - pair.truth.translation).norm());
      }
    }
    if (!all) continue;
    ++locked;
    for (std::size_t i = 0; i < sights.size(); ++i) times[i].push_back(spent[i]);
  }
  char note[120];
  std::snprintf(note, sizeof note, "all locked in %d of %d frames, worst error %.2f mm", locked,
                frames, 1e3 * worst);
  add_rows("frame to pose, locked", "ms", 1e-6, times, locked, note, results);
}

}  // namespace

void bench_refraction(const Options& options, Results& results) {
  results.group("bent light",
                "The same target at the same poses, seen by cameras in air, behind flat ports (60 "
                "mm before the lens, 15 mm thick, 2 degrees off square), through Brown lenses, and "
                "both; turn by turn beside each other.");
  std::vector<Sight> sights = sights_of(options);
  bench_search(sights, options, results);
  bench_refinement(sights, options, results);
  bench_locked(sights, options, results);
}

}  // namespace gannet::bench
