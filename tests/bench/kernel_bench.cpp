// Nanoseconds per point of each kernel, for each variant that runs here.
#include "src/vision/kernel_choice.hpp"
#include "src/vision/reference.hpp"
#include "tests/bench/bare_loads.hpp"
#include "tests/bench/benches.hpp"
#include "tests/bench/workload.hpp"

namespace gannet::bench {
namespace {

using vision::CorrelationSums;
using vision::Kernels;
using vision::PointSet;

// Visits the candidates of a turn, eye by eye; returns the points visited.
template <class F>
double for_turn(const Workload& work, int turn, F&& visit) {
  const std::size_t first = work.first(turn);
  for (std::size_t i = first; i < first + kTurnCandidates; ++i) {
    if (!work.left.empty()) visit(true, i, work.left[i]);
    visit(false, i, work.right[i]);
  }
  return kTurnCandidates * work.eyes() * work.points().points();
}

Contender reference_projection(const Workload& work) {
  return {"reference", [&work](int turn) {
            const PointSet& set = work.points();
            return for_turn(work, turn, [&](bool left, std::size_t i, const EyeCells&) {
              int sum = 0;
              for (std::size_t k = 0; k < set.x.size(); ++k) {
                if (!(set.x[k] == set.x[k])) continue;  // padding
                const auto pixel = vision::reference::pixel_of(
                    work.rig, left, work.poses[i], static_cast<double>(set.x[k]),
                    static_cast<double>(set.y[k]), work.target().unscaled);
                sum += pixel ? pixel->x() : -1;
              }
              consume(sum);
            });
          }};
}

// Whole evaluations by the reference: what is left when its projection is taken off is the rest.
template <class F>
Contender reference_whole(const Workload& work, F&& score) {
  return {"reference, whole", [&work, score](int turn) {
            const std::size_t first = work.first(turn);
            for (std::size_t i = first; i < first + kTurnCandidates; ++i) consume(score(i));
            return kTurnCandidates * work.eyes() * work.points().points();
          }};
}

template <class Cell>
Contender loads(const Workload& work, const Cell* vision::EyePlanes::*plane) {
  return {"bare loads", [&work, plane](int turn) {
            return for_turn(work, turn, [&](bool left, std::size_t, const EyeCells& eye) {
              const auto& planes = left ? work.frame->left() : work.frame->right();
              consume(bare_loads(planes.*plane, eye.index));
            });
          }};
}

Contender packed_loads(const Workload& work) {
  return {"bare loads", [&work](int turn) {
            return for_turn(work, turn, [&](bool left, std::size_t, const EyeCells& eye) {
              const auto& planes = left ? work.frame->left() : work.frame->right();
              consume(bare_loads(planes.packed[0].cells, eye.index));
            });
          }};
}

// One contender for each variant of a kernel.
template <class F>
void add_variants(const Workload& work, F&& run, std::vector<Contender>& to) {
  for (const Kernels* k : vision::kernels_here()) {
    to.push_back({k->name, [&work, run, k](int turn) {
                    return for_turn(work, turn, [&](bool left, std::size_t, const EyeCells& eye) {
                      run(*k, left, eye);
                    });
                  }});
  }
}

struct Against {
  std::vector<double> reference, scalar, loads;
};

void add_rows(const std::string& kernel, const Against& against,
              const std::vector<std::vector<double>>& times, std::size_t first_variant,
              Results& results) {
  std::size_t at = first_variant;
  for (const Kernels* k : vision::kernels_here()) {
    const std::vector<double>& own = times[at++];
    Row row = {kernel + ", " + k->name,      "ns/point", spread_of(own),
               static_cast<int>(own.size()), {},         ""};
    row.ratios.push_back(
        {"times faster than reference", spread_of(ratios_of(against.reference, own))});
    row.ratios.push_back({"times faster than scalar", spread_of(ratios_of(against.scalar, own))});
    if (!against.loads.empty()) {
      row.ratios.push_back({"times the bare loads", spread_of(ratios_of(own, against.loads))});
    }
    results.add(row);
  }
}

std::vector<double> less(std::vector<double> whole, const std::vector<double>& part) {
  for (std::size_t i = 0; i < whole.size(); ++i) whole[i] -= part[i];
  return whole;
}

void bench_projection(const std::string& name, const Workload& work, int turns, Results& results) {
  const vision::CameraModel left(work.rig.left, nullptr);
  const vision::CameraModel right(work.rig.right, &work.rig.right_from_left);
  std::vector<std::int32_t> index(static_cast<std::size_t>(work.points().total_padded));
  std::vector<Contender> contenders = {reference_projection(work)};
  add_variants(
      work,
      [&](const Kernels& k, bool is_left, const EyeCells& eye) {
        const PointSet& set = work.points();
        consume((is_left ? left : right)
                    .project(k, set.x.data(), set.y.data(), set.total_padded, eye.view, 0,
                             index.data()));
      },
      contenders);
  const auto times = interleave(contenders, turns);
  add_rows(name, {times[0], times[1], {}}, times, 1, results);
}

// Kernels that sample: reference less its projection, bare loads, variants.
template <class Score, class Run>
void bench_sampling(const std::string& name, const Workload& work, int turns, const Contender& bare,
                    Score&& score, Run&& run, Results& results) {
  std::vector<Contender> contenders = {reference_whole(work, score), reference_projection(work),
                                       bare};
  add_variants(work, run, contenders);
  const auto times = interleave(contenders, turns);
  add_rows(name, {less(times[0], times[1]), times[3], times[2]}, times, 3, results);
  results.add({name + ", bare loads", "ns/point", spread_of(times[2]), turns, {}, ""});
}

}  // namespace

void bench_kernels(const Options& options, Results& results) {
  results.group(
      "kernels",
      "Nanoseconds per point of the model, padding not counted, on the poses that a differential "
      "evolution proposed while it searched the same frame, another 16 for each contender and "
      "turn. reference: "
      "doubles straight from the equations; for kernels that sample, its whole evaluation less its "
      "projection. Bare loads: the same cells at ready-made indices read from memory, summed. "
      "Each turn's work is done once untimed before: caches are as warm as a search keeps them.");
  const ClutteredScene scene(options.width(), options.height());
  const int turns = options.turns();
  const Workload work = model_workload(scene, 500, options.candidates(), false);
  bench_projection("project", work, turns, results);
  bench_projection("project_lens", model_workload(scene, 500, options.candidates(), true), turns,
                   results);
  const PointSet& set = work.points();
  bench_sampling(
      "correlate", work, turns, packed_loads(work),
      [&](std::size_t i) {
        return vision::reference::correlation(work.rig, work.target(), *work.frame, work.poses[i],
                                              {});
      },
      [&](const Kernels& k, bool left, const EyeCells& eye) {
        const auto& planes = left ? work.frame->left() : work.frame->right();
        CorrelationSums sums;
        k.correlate(planes.packed[0].cells, eye.index.data(), set.total_padded,
                    set.correlation.data(), eye.visible == set.points(), sums);
        consume(sums.im[0]);
      },
      results);
  bench_sampling(
      "vote", work, turns, loads(work, &vision::EyePlanes::hue_value),
      [&](std::size_t i) {
        return vision::reference::photo_model(work.rig, work.target(), *work.frame, work.poses[i],
                                              vision::VoteRule::kP001);
      },
      [&](const Kernels& k, bool left, const EyeCells& eye) {
        const auto& planes = left ? work.frame->left() : work.frame->right();
        vision::VoteCounts counts;
        k.vote(planes.hue_value, eye.index.data(), set.inside_padded,
               set.total_padded - set.inside_padded, eye.view.guard, set.hue.data(),
               set.is_background.data(), work.target().background_hue, counts);
        consume(counts.in_match);
      },
      results);
  const Workload patch = rectangle_workload(scene, options.candidates());
  const PointSet& own = patch.points();
  bench_sampling(
      "compare", patch, turns, loads(patch, &vision::EyePlanes::hue_value),
      [&](std::size_t i) {
        return vision::reference::projection(patch.rig, patch.target(), *patch.frame,
                                             patch.poses[i]);
      },
      [&](const Kernels& k, bool, const EyeCells& eye) {
        vision::ProjectionCounts counts;
        k.compare(patch.frame->right().hue_value, eye.index.data(), own.total_padded,
                  eye.view.guard, own.hue_value.data(), counts);
        consume(counts.hue_match);
      },
      results);
}

}  // namespace gannet::bench
