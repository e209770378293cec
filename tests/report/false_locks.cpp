#include "tests/report/false_locks.hpp"

#include <atomic>
#include <cmath>

#include "src/report/statistics.hpp"
#include "src/report/table.hpp"
#include "src/track/search_space.hpp"
#include "src/track/target_tracker.hpp"
#include "src/track/track_config.hpp"
#include "tests/report/contest.hpp"

namespace gannet::robustness {
namespace {

constexpr double kFramesPerSecond = 30;
const track::TrackConfig kConfig;

// What the tracker is asked to look at.
track::SearchSpace asked_space(const StereoRig& rig) {
  constexpr double kRadians = 3.14159265358979323846 / 180;
  return {rig,
          {kConfig.z_min_m, kConfig.z_max_m, kConfig.half_width_x_m, kConfig.half_width_y_m,
           kConfig.tilt_deg * kRadians, kConfig.roll_deg * kRadians}};
}

struct Bench {
  const Cast* cast;
  track::SearchSpace asked;
  Studio studio;
  std::unique_ptr<track::TargetTracker> tracker;
};

// Clips take turns with light and water, in which recognition still holds.
Conditions conditions_of(int clip) {
  constexpr std::array<double, 3> kLux = {400, 50, 10}, kTurbidity = {0, 1, 2};
  Conditions out;
  out.light_lux = kLux[static_cast<std::size_t>(clip / 5 % 3)];
  out.turbidity_per_m = kTurbidity[static_cast<std::size_t>(clip / 15 % 3)];
  out.distractors = 2 + clip % 4 * 2;
  return out;
}

// Everything but the bottom drifts, each on its own straight way. The target is the first object.
class Drift {
 public:
  Drift(std::size_t objects, Random& random) {
    for (std::size_t i = 0; i < objects; ++i) {
      Eigen::Vector3d v;
      for (double& axis : v) axis = 0.03 * (2 * random.uniform() - 1);
      step_m_.push_back(v / kFramesPerSecond);
    }
  }
  void move(Staged& staged) const {
    for (std::size_t i = 0; i < step_m_.size(); ++i)
      staged.scene.objects[i].pose.translation += step_m_[i];
    if (!step_m_.empty()) staged.truth.translation += step_m_[0];
  }

 private:
  std::vector<Eigen::Vector3d> step_m_;
};

void count_with(const PoseEstimate& got, const Staged& staged, const Bench& bench,
                LockCount& count) {
  const bool detected =
      got.state == TrackState::kLocked && got.found && is_right(got.left_from_target, staged.truth);
  ++count.frames_with;
  count.detected += detected;
  if (!sees_all(*bench.cast, staged) || !bench.asked.contains(staged.truth)) return;
  ++count.frames_asked;
  count.detected_asked += detected;
}

void count_without(const PoseEstimate& got, bool& was, LockCount& count) {
  const bool locked = got.state == TrackState::kLocked;
  ++count.frames;
  count.locked += locked;
  count.false_locks += locked && !was;
  was = locked;
}

LockCount play(int clip, Show show, Bench& bench, std::uint64_t seed) {
  // Clips with and without the target have different dice.
  const int number = 2 * clip + (show == Show::kTarget);
  const Conditions conditions = conditions_of(clip);
  Staged staged = bench.studio.stage(conditions, clip, number, show);
  Random random(world::hashed(seed + 1, static_cast<std::uint64_t>(number)));
  const Drift drift(staged.scene.objects.size(), random);
  bench.tracker->choose_none();
  bench.tracker->choose_model(staged.creature, 1);
  LockCount count;
  Serial serial;
  bool was = false;
  for (int frame = 0; frame < kClipFrames; ++frame, drift.move(staged)) {
    const Shot shot = bench.studio.shoot(staged, conditions.blur_px, number * kClipFrames + frame);
    const TimePoint time = time_from_ns(0) + from_seconds(1 + frame / kFramesPerSecond);
    const PoseEstimate got = bench.tracker->process(shot.left.view(), shot.right.view(), time,
                                                    static_cast<std::uint64_t>(frame), {}, serial);
    if (show == Show::kDistractorsAlone) {
      count_without(got, was, count);
    } else if (frame >= kSettleFrames) {
      count_with(got, staged, bench, count);
    }
  }
  count.missed_clips = show == Show::kTarget && count.detected == 0;
  return count;
}

Result<std::vector<Bench>> make_benches(int workers, const Campaign& campaign, const Cast& cast) {
  std::vector<Bench> out;
  for (int i = 0; i < workers; ++i) {
    auto tracker = track::TargetTracker::create(kConfig, cast.rig, cast.models);
    if (!tracker) return tracker.error();
    out.push_back({&cast, asked_space(cast.rig), Studio(cast, campaign.seed), std::move(*tracker)});
  }
  return out;
}

std::string share_of(long part, long whole) {
  if (whole == 0) return "none of 0";
  const double share = static_cast<double>(part) / static_cast<double>(whole);
  return report::number(100 * share, 2) + " % of " + std::to_string(whole);
}

}  // namespace

Result<LockCount> count_locks(const Campaign& campaign, const Cast& cast, Parallel& parallel,
                              const std::function<void(long)>& done) {
  auto benches = make_benches(parallel.workers(), campaign, cast);
  if (!benches) return benches.error();
  std::vector<LockCount> counts(static_cast<std::size_t>(campaign.clips + campaign.clips_with));
  std::atomic<long> finished = 0;  // nothing is read through it
  parallel.for_each(static_cast<int>(counts.size()), [&](int i, int worker) {
    const bool with = i >= campaign.clips;
    counts[static_cast<std::size_t>(i)] =
        play(with ? i - campaign.clips : i, with ? Show::kTarget : Show::kDistractorsAlone,
             (*benches)[static_cast<std::size_t>(worker)], campaign.seed);
    const long n = finished.fetch_add(1, std::memory_order_relaxed) + 1;
    if (worker == 0) done(n);
  });
  LockCount sum;
  for (const LockCount& c : counts) {
    sum.frames += c.frames, sum.locked += c.locked, sum.false_locks += c.false_locks;
    sum.frames_with += c.frames_with, sum.detected += c.detected;
    sum.frames_asked += c.frames_asked, sum.detected_asked += c.detected_asked;
    sum.missed_clips += c.missed_clips;
  }
  return sum;
}

std::string lock_summary(const LockCount& count) {
  using report::number;
  const double hours = static_cast<double>(count.frames) / kFramesPerSecond / 3600;
  const auto [low, high] = report::poisson95(count.false_locks);
  return "without the target: " + std::to_string(count.false_locks) + " false locks in " +
         number(hours, 3) + " h (" + std::to_string(count.frames) + " frames, " +
         std::to_string(count.locked) + " locked): 95 % interval " + number(low / hours, 2) +
         " ... " + number(high / hours, 2) + " an hour\nwith it: locked on the right pose in " +
         share_of(count.detected, count.frames_with) + " frames; never in " +
         std::to_string(count.missed_clips) +
         " clips\nof these, all of it in both views and in the " +
         "volume that is searched: " + share_of(count.detected_asked, count.frames_asked) + "\n";
}

}  // namespace gannet::robustness
