// Whole evaluations: views, projection, sampling and score of both eyes, as a search calls them.
#include <cmath>

#include "src/vision/fitness_kinds.hpp"
#include "src/vision/kernel_choice.hpp"
#include "src/vision/projection_fitness.hpp"
#include "src/vision/reference.hpp"
#include "tests/bench/bare_loads.hpp"
#include "tests/bench/benches.hpp"
#include "tests/bench/workload.hpp"

namespace gannet::bench {
namespace {

double reference_score(const std::string& fitness, const Workload& work, std::size_t i) {
  namespace reference = vision::reference;
  const auto& [rig, target, frame, pose] =
      std::tie(work.rig, work.target(), *work.frame, work.poses[i]);
  if (fitness == "p000") return reference::projection(rig, target, frame, pose);
  if (fitness == "gannet") return reference::correlation(rig, target, frame, pose, {});
  const auto rule = fitness == "p001" ? vision::VoteRule::kP001 : vision::VoteRule::kP002;
  return reference::photo_model(rig, target, frame, pose, rule);
}

double loads_of_turn(bool packed, const Workload& work, int turn) {
  const std::size_t first = work.first(turn);
  const auto load = [packed](const vision::EyePlanes& planes, const EyeCells& eye) {
    consume(packed ? bare_loads(planes.packed[0].cells, eye.index)
                   : bare_loads(planes.hue_value, eye.index));
  };
  for (std::size_t i = first; i < first + kTurnCandidates; ++i) {
    if (!work.left.empty()) load(work.frame->left(), work.left[i]);
    load(work.frame->right(), work.right[i]);
  }
  return kTurnCandidates;
}

struct Case {
  std::string fitness;
  const Workload* work;
  double goal_evaluations;  // per 33 ms and core; 0: none
};

void bench_one(const Case& c, int turns, Results& results) {
  const Workload& work = *c.work;
  const bool packed = c.fitness == "gannet";
  const double samples = work.eyes() * work.points().points();
  std::vector<Contender> contenders = {
      {"reference",
       [&](int turn) {
         const std::size_t first = work.first(turn);
         for (std::size_t i = 0; i < kTurnCandidates; ++i) {
           consume(reference_score(c.fitness, work, first + i));
         }
         return kTurnCandidates;
       }},
      {"bare loads", [&](int turn) { return loads_of_turn(packed, work, turn); }}};
  std::vector<std::unique_ptr<vision::Fitness>> fitnesses;
  vision::Scratch scratch(track::Recogniser::max_points());
  std::array<float, kTurnCandidates> scores;
  for (const vision::Kernels* k : vision::kernels_here()) {
    fitnesses.push_back(
        vision::make_fitness(c.fitness, work.target().unscaled, work.rig, *k).value());
    contenders.push_back({k->name, [&, f = fitnesses.back().get()](int turn) {
                            f->score(work.target(), *work.frame, 0,
                                     {work.candidates.data() + work.first(turn), kTurnCandidates},
                                     scores, scratch);
                            consume(static_cast<double>(scores[0]));
                            return kTurnCandidates;
                          }});
  }
  const auto times = interleave(contenders, turns);
  const vision::Kernels* best = vision::find_kernels("auto");
  const std::string points = std::to_string(work.points().points()) + " points x " +
                             std::to_string(static_cast<int>(work.eyes())) + " images";
  std::size_t at = 2;
  for (const vision::Kernels* k : vision::kernels_here()) {
    std::vector<double> per_point, per_frame;
    for (const double ns : times[at]) {
      per_point.push_back(ns / samples);
      per_frame.push_back(33e6 / ns);
    }
    Row row = {c.fitness + ", " + k->name, "ns/point", spread_of(per_point), turns, {}, points};
    row.ratios = {{"times faster than reference", spread_of(ratios_of(times[0], times[at]))},
                  {"times faster than scalar", spread_of(ratios_of(times[2], times[at]))},
                  {"times the bare loads", spread_of(ratios_of(times[at], times[1]))}};
    const bool judged = k == best && c.goal_evaluations > 0;
    if (judged) {
      row.goals = {at_least(20, row.ratios[0].text, row.ratios[0].value.median),
                   at_most(1.5, row.ratios[2].text, row.ratios[2].value.median)};
    }
    results.add(row);
    row = {c.fitness + ", " + k->name + ", throughput",
           "evaluations per 33 ms and core",
           spread_of(per_frame),
           turns,
           {},
           points};
    if (judged) row.goals = {at_least(c.goal_evaluations, row.unit, row.value.median)};
    results.add(row);
    ++at;
  }
}

}  // namespace

void bench_fitness(const Options& options, Results& results) {
  results.group("whole evaluations",
                "Fitness::score in batches of 16 poses of the same search: views, projection, "
                "sampling, score; gannet with its seven sums for each of three channels. Ratios "
                "to the reference's whole evaluation and to the bare loads of both images.");
  const ClutteredScene scene(options.width(), options.height());
  // The smallest model of at least 500 points in all.
  int inside = 300;
  while (static_cast<int>(scene.model(inside).points.size()) < 500) inside += 20;
  const Workload model = model_workload(scene, inside, options.candidates(), false);
  const Workload patch = rectangle_workload(scene, options.candidates());
  for (const Case& c : {Case{"p001", &model, 20'000}, Case{"p002", &model, 20'000},
                        Case{"gannet", &model, 10'000}, Case{"p000", &patch, 0}}) {
    bench_one(c, options.turns(), results);
  }
}

}  // namespace gannet::bench
