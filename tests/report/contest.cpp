#include "tests/report/contest.hpp"

#include <atomic>
#include <cmath>

#include "src/report/statistics.hpp"
#include "src/track/recogniser.hpp"

namespace gannet::robustness {
namespace {

// What one worker needs.
struct Bench {
  Studio studio;
  std::unique_ptr<vision::PreparedFrame> frame;
  std::array<std::unique_ptr<track::Recogniser>, kMethods.size()> recognisers;
};

Result<Bench> make_bench(const Contest& contest, const Cast& cast) {
  const Intrinsics& camera = cast.rig.left;
  Bench bench = {
      Studio(cast, contest.seed),
      std::make_unique<vision::PreparedFrame>(
          camera.width, camera.height, vision::PlaneNeeds{.packed = true, .hue_value = true}),
      {}};
  for (std::size_t i = 0; i < kMethods.size(); ++i) {
    track::TrackConfig config;
    config.optimiser = kMethods[i].optimiser;
    config.fitness = kMethods[i].fitness;
    auto made = track::Recogniser::create(config, cast.rig, track::TargetKind::kModel);
    if (!made) return made.error();
    bench.recognisers[i] = std::move(*made);
  }
  return bench;
}

Outcome outcome_of(const Pose& found, const Pose& truth) {
  const Eigen::Vector3d d = 1000 * (found.translation - truth.translation);
  const auto turn = canonical(found.rotation * truth.rotation.conjugate());
  Outcome out;
  out.side_mm = d.head<2>().norm();
  out.depth_mm = std::abs(d.z());
  out.angle_deg = rotation_vector_from_quaternion(turn).norm() * 180 / 3.14159265358979;
  out.right = std::abs(d.x()) < kSide_mm && std::abs(d.y()) < kSide_mm &&
              out.depth_mm < kDepth_mm && out.angle_deg < kAngle_deg;
  return out;
}

// Which trial of which cell a piece of work is.
struct Place {
  std::size_t plane;
  int cell, trial;
};

void play(const Contest& contest, const Cast& cast, const Conditions& conditions, int trial,
          int number, Bench& bench, Cell& cell) {
  const Shot shot = bench.studio.take(conditions, trial, number);
  bench.frame->prepare(shot.left.view(), shot.right.view());
  Serial serial;
  for (std::size_t i = 0; i < kMethods.size(); ++i) {
    track::Recogniser& sut = *bench.recognisers[i];
    sut.set_model(cast.models[static_cast<std::size_t>(shot.creature)]);
    const auto got =
        sut.recognise(*bench.frame, nullptr, {.evaluations = double(contest.evaluations)}, serial);
    Outcome& outcome = cell.trials[i][static_cast<std::size_t>(trial)];
    outcome = outcome_of(got.left_from_target, shot.truth);
    outcome.trusted = got.found;
  }
}

}  // namespace

bool is_right(const Pose& found, const Pose& truth) { return outcome_of(found, truth).right; }

Result<std::vector<std::vector<Cell>>> run(const Contest& contest, const Cast& cast,
                                           std::span<const Plane> planes, Parallel& parallel,
                                           const std::function<void(long)>& done) {
  std::vector<Bench> benches;
  for (int i = 0; i < parallel.workers(); ++i) {
    auto bench = make_bench(contest, cast);
    if (!bench) return bench.error();
    benches.push_back(std::move(*bench));
  }
  std::vector<std::vector<Cell>> cells(planes.size());
  std::vector<Place> work;
  for (std::size_t p = 0; p < planes.size(); ++p) {
    cells[p].resize(static_cast<std::size_t>(planes[p].cells()));
    for (int c = 0; c < planes[p].cells(); ++c) {
      for (auto& outcomes : cells[p][static_cast<std::size_t>(c)].trials)
        outcomes.resize(static_cast<std::size_t>(contest.trials));
      for (int t = 0; t < contest.trials; ++t) work.push_back({p, c, t});
    }
  }
  std::atomic<long> finished = 0;  // nothing is read through it
  parallel.for_each(static_cast<int>(work.size()), [&](int i, int worker) {
    const Place& at = work[static_cast<std::size_t>(i)];
    play(contest, cast, planes[at.plane].at(at.cell), at.trial, i,
         benches[static_cast<std::size_t>(worker)],
         cells[at.plane][static_cast<std::size_t>(at.cell)]);
    const long n = finished.fetch_add(1, std::memory_order_relaxed) + 1;
    if (worker == 0) done(n);
  });
  return cells;
}

Score score_of(std::span<const Outcome> outcomes) {
  Score score;
  std::vector<double> side, depth, angle;
  for (const Outcome& o : outcomes) {
    ++score.trials;
    score.trusted_wrong += o.trusted && !o.right;
    if (!o.right) continue;
    ++score.right;
    side.push_back(o.side_mm);
    depth.push_back(o.depth_mm);
    angle.push_back(o.angle_deg);
  }
  score.side_mm = report::percentile(side, 50);
  score.depth_mm = report::percentile(depth, 50);
  score.angle_deg = report::percentile(angle, 50);
  return score;
}

}  // namespace gannet::robustness
