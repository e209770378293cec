// Whole stages of a frame: preparing the planes, and frame to pose while locked.
#include <cmath>
#include <cstring>
#include <numeric>

#include "src/track/recogniser.hpp"
#include "src/track/target_tracker.hpp"
#include "src/track/track_config.hpp"
#include "src/track/track_state.hpp"
#include "src/vision/hue_value.hpp"
#include "src/vision/prepared_frame.hpp"
#include "src/vision/refine.hpp"
#include "tests/bench/benches.hpp"
#include "tests/bench/cluttered_scene.hpp"

namespace gannet::bench {
namespace {

std::vector<Pair> moving_target(const ClutteredScene& scene, int frames) {
  std::vector<Pair> pairs;
  for (int i = 0; i < frames; ++i) {
    const double t = 6.2832 * i / frames;
    const Pose pose =
        test::pose_at(0.06 + 0.05 * std::sin(t), 0.03 * std::cos(t), 0.6 + 0.05 * std::sin(t),
                      10 * std::cos(t), 8, 12 * std::sin(t));
    pairs.push_back(scene.see(pose, 5));
  }
  return pairs;
}

Contender copy_pair(const std::vector<Pair>& pairs, std::vector<std::uint8_t>& into) {
  return {"memcpy", [&](int turn) {
            const Pair& p = pairs[static_cast<std::size_t>(turn) % pairs.size()];
            const auto left = p.left.bytes(), right = p.right.bytes();
            into.resize(left.size() + right.size());
            std::memcpy(into.data(), left.data(), left.size());
            std::memcpy(into.data() + left.size(), right.data(), right.size());
            consume(into[static_cast<std::size_t>(turn)]);
            return 1.0;
          }};
}

std::vector<double> in_ms(std::vector<double> ns) {
  for (double& t : ns) t /= 1e6;
  return ns;
}

void bench_prepare(const std::vector<Pair>& pairs, const Options& options, Results& results) {
  std::vector<std::uint8_t> into;
  std::vector<Contender> contenders = {copy_pair(pairs, into)};
  struct Kind {
    const char* name;
    vision::PlaneNeeds needs;
  };
  const Kind kinds[] = {{"prepare, packed planes", {.packed = true, .hue_value = false}},
                        {"prepare, hue and value", {.packed = false, .hue_value = true}},
                        {"prepare, both", {.packed = true, .hue_value = true}}};
  std::vector<std::unique_ptr<vision::PreparedFrame>> frames;
  for (const Kind& kind : kinds) {
    frames.push_back(
        std::make_unique<vision::PreparedFrame>(options.width(), options.height(), kind.needs));
    contenders.push_back({kind.name, [&, f = frames.back().get()](int turn) {
                            const Pair& p = pairs[static_cast<std::size_t>(turn) % pairs.size()];
                            f->prepare(p.left.view(), p.right.view());
                            return 1.0;
                          }});
  }
  const auto times = interleave(contenders, options.turns(), Caches::kAsFound);
  results.add({"memcpy of the pair", "ms", spread_of(in_ms(times[0])), options.turns(), {}, ""});
  for (std::size_t i = 1; i < times.size(); ++i) {
    results.add({contenders[i].name,
                 "ms",
                 spread_of(in_ms(times[i])),
                 options.turns(),
                 {{"times the memcpy", spread_of(ratios_of(times[i], times[0]))}},
                 ""});
  }
}

void bench_refine(const ClutteredScene& scene, const std::vector<Pair>& pairs,
                  const Options& options, Results& results) {
  const track::TrackConfig config;
  const auto recogniser =
      track::Recogniser::create(config, scene.rig(), track::TargetKind::kModel).value();
  recogniser->set_model(scene.model(config.model_points));
  const vision::PointSet& points = recogniser->target().level[0];
  vision::PreparedFrame frame(options.width(), options.height(), recogniser->needs());
  frame.prepare(pairs[0].left.view(), pairs[0].right.view());
  std::vector<std::uint8_t> into;
  const auto times =
      interleave({copy_pair(pairs, into),
                  {"refine",
                   [&](int data) {
                     Pose start = pairs[0].truth;
                     start.translation += Eigen::Vector3d(1, -1, 2) * (1e-3 * (1 + data % 3));
                     const auto got = vision::refine_pose(scene.rig(), points, frame, start, {});
                     consume(got.left_from_target.translation.z());
                     return 1.0;
                   }}},
                 options.turns(), Caches::kAsFound);
  results.add({"refinement of one pose",
               "ms",
               spread_of(in_ms(times[1])),
               options.turns(),
               {{"times the memcpy", spread_of(ratios_of(times[1], times[0]))}},
               std::to_string(points.points()) + " points x 2 images, 2 to 7 mm off"});
}

void bench_tracker(const ClutteredScene& scene, const std::vector<Pair>& pairs,
                   const Options& options, Results& results) {
  const track::TrackConfig config;
  const auto sut =
      track::TargetTracker::create(config, scene.rig(), {scene.model(config.model_points)}).value();
  sut->choose_model(0, 1);
  Serial serial;
  std::uint64_t number = 0;
  int locked = 0;
  double worst = 0, evaluations = 0;
  std::vector<double> own, copies;
  std::vector<std::uint8_t> into;
  const Contender copy = copy_pair(pairs, into);
  const int frames = options.quick ? 5 : 300;
  // Until it is locked a frame may cost ten times as much; those are not counted.
  for (int i = 0; i < frames + 3; ++i) {
    const Pair& p = pairs[static_cast<std::size_t>(i) % pairs.size()];
    double start = thread_cpu_ns();
    copy.work(i);
    const double copied = thread_cpu_ns() - start;
    const TimePoint time = time_from_ns(33'000'000LL * (i + 1));
    start = thread_cpu_ns();
    const PoseEstimate got =
        sut->process(p.left.view(), p.right.view(), time, ++number, {}, serial);
    const double spent = thread_cpu_ns() - start;
    if (i < 3 || got.state != TrackState::kLocked) continue;
    ++locked;
    worst = std::max(worst, (got.left_from_target.translation - p.truth.translation).norm());
    evaluations += got.evaluations;
    own.push_back(spent);
    copies.push_back(copied);
  }
  double sum = 0;
  for (const double ns : own) sum += ns;
  char note[240];
  const double n = std::max<double>(1, static_cast<double>(own.size()));
  std::snprintf(note, sizeof note,
                "mean %.3f ms, p50 %.3f ms, p99 %.3f ms; memcpy mean %.3f ms; locked in %d of %d "
                "frames, worst error %.1f mm; %.0f evaluations a frame, the global check's coarse "
                "ones among them",
                sum / n / 1e6, quantile(own, 0.5) / 1e6, quantile(own, 0.99) / 1e6,
                std::accumulate(copies.begin(), copies.end(), 0.0) / n / 1e6, locked, frames,
                1e3 * worst, evaluations / n);
  results.add({"frame to pose, locked",
               "ms",
               spread_of(in_ms(own)),
               static_cast<int>(own.size()),
               {{"times the memcpy", spread_of(ratios_of(own, copies))}},
               note,
               {at_most(1.3, "ms, mean", sum / n / 1e6),
                at_most(2, "ms, p99", quantile(own, 0.99) / 1e6)}});
}

}  // namespace

void bench_frame(const Options& options, Results& results) {
  results.group("stages of a frame",
                "One YUYV pair, the daemon's default configuration, one core. prepare: unpacking, "
                "smoothing, pyramid, cells. Frame to pose: all of TargetTracker::process on a "
                "target that moves. Beside each the memcpy of the same pair in the same turn.");
  vision::hue_value_table();
  const ClutteredScene scene(options.width(), options.height());
  const std::vector<Pair> pairs = moving_target(scene, options.quick ? 2 : 24);
  bench_prepare(pairs, options, results);
  bench_refine(scene, pairs, options, results);
  bench_tracker(scene, pairs, options, results);
}

}  // namespace gannet::bench
