// Gannet beside OpenCV, ViSP and AprilTag on the same rendered views; `make bench-peers`.
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <opencv2/core/utility.hpp>
#include <string>
#include <string_view>

#include "tests/bench/peers/evaluation.hpp"
#include "tests/bench/peers/peers.hpp"
#include "tests/bench/results.hpp"

namespace gannet::bench {
namespace {

constexpr const char* kHelp =
    "peers [--views N] [--films N] [--json FILE] [--flags TEXT] [--commit TEXT]\n"
    "  --views   single views in each condition, 60 unless told\n"
    "  --films   films of 40 frames in each condition, 3 unless told\n";

constexpr Condition kConditions[] = {{"bright", 400, false, 0},
                                     {"30 % hidden", 400, false, 0.3},
                                     {"50 % hidden", 400, false, 0.5},
                                     {"dark, 5 lx", 5, false, 0},
                                     {"turbid", 400, true, 0}};

struct Tally {
  std::vector<double> ms, mm, degrees;  // errors: of the right answers
  int right = 0, wrong = 0;
};

void judge(const Answer& got, const Pose& truth, Tally& tally) {
  if (!got.found) return;
  const Eigen::Vector3d d = got.pose.translation - truth.translation;
  const double degrees =
      rotation_vector_from_quaternion(canonical(got.pose.rotation * truth.rotation.conjugate()))
          .norm() *
      180 / 3.14159265358979;
  if (std::abs(d.x()) < 0.01 && std::abs(d.y()) < 0.01 && std::abs(d.z()) < 0.02 && degrees < 10) {
    ++tally.right;
    tally.mm.push_back(1000 * d.norm());
    tally.degrees.push_back(degrees);
  } else {
    ++tally.wrong;
  }
}

using Peers = std::vector<std::unique_ptr<Peer>>;

// One frame before all contenders, in turns; ours is the first.
void show(const Peers& peers, Views& views, const Condition& condition, const Pose& pose,
          std::uint64_t number, bool counts, std::vector<Tally>& tallies) {
  const View plain = views.see(condition, false, pose, number);
  const View tag = views.see(condition, true, pose, number);
  for (std::size_t i = 0; i < peers.size(); ++i) {
    const double start = thread_cpu_ns();
    const Answer got = peers[i]->look(peers[i]->wants_tag() ? tag : plain);
    const double ms = (thread_cpu_ns() - start) / 1e6;
    if (!counts) continue;
    tallies[i].ms.push_back(ms);
    judge(got, pose, tallies[i]);
  }
}

void report(const Peers& peers, const Condition& condition, const std::vector<Tally>& tallies,
            Results& results) {
  for (std::size_t i = 0; i < peers.size(); ++i) {
    const Tally& tally = tallies[i];
    const int n = static_cast<int>(tally.ms.size());
    char note[160];
    const auto at = static_cast<std::size_t>(std::snprintf(note, sizeof note, "%d wrong; %.2f ms",
                                                           tally.wrong, quantile(tally.ms, 0.5)));
    if (tally.right > 0) {
      std::snprintf(note + at, sizeof note - at,
                    "; of the right ones median %.2f mm, 90 %% %.2f mm, %.2f degrees",
                    quantile(tally.mm, 0.5), quantile(tally.mm, 0.9), quantile(tally.degrees, 0.5));
    }
    results.add({std::string(peers[i]->name()) + ", " + condition.name,
                 "% right, Wilson 95 %",
                 wilson_percent(tally.right, n),
                 n,
                 {{"times our time", spread_of(ratios_of(tally.ms, tallies[0].ms))}},
                 note});
  }
}

void single_views(const Peers& peers, Views& views, int count, Results& results) {
  results.group("single views",
                "A textured square of 140 mm (the tag: as large with its margin) at random poses, "
                "z 0.4 to 0.9 m, tilts 35, roll 40 degrees, 640 x 480; each view found from "
                "nothing. One photo in air at 0.4 m. Right: within 10 mm, 20 mm in z, 10 degrees. "
                "The peers use the left camera, Gannet both. CPU time of one thread.");
  for (const Condition& condition : kConditions) {
    Random random(2025);
    std::vector<Tally> tallies(peers.size());
    for (int i = 0; i < count; ++i) {
      const Pose pose = random_pose(views.rig(), random);
      for (const auto& peer : peers) peer->begin(pose);
      show(peers, views, condition, pose, static_cast<std::uint64_t>(i), true, tallies);
    }
    report(peers, condition, tallies, results);
  }
}

void films(const Peers& peers, Views& views, int count, Results& results) {
  constexpr int kFrames = 40, kSettle = 3;
  results.group(
      "films",
      "The same square in motion, up to 6 mm, 4 mm in z and 1.2 degrees a frame. ECC and "
      "ViSP are given the true first pose; the others find it. The first 3 frames do not count. "
      "Frames of a film are not independent: the interval is narrower than it ought to.");
  for (const Condition& condition : kConditions) {
    Random random(2026);
    std::vector<Tally> tallies(peers.size());
    for (int film = 0; film < count; ++film) {
      Pose middle = random_pose(views.rig(), random);
      middle.translation.head<2>() *= 0.3;  // so that the motion stays in view
      middle.translation.x() += 0.05;
      for (const auto& peer : peers) peer->begin(pose_in_film(middle, 0));
      for (int i = 0; i < kFrames; ++i) {
        const auto number = static_cast<std::uint64_t>(film * kFrames + i);
        show(peers, views, condition, pose_in_film(middle, i), number, i >= kSettle, tallies);
      }
    }
    report(peers, condition, tallies, results);
  }
}

int run(int view_count, int film_count, const std::string& json, const std::string& flags,
        const std::string& commit) {
  cv::setNumThreads(1);
  Results results(this_machine(flags, commit));
  Views views(april_tag_picture());
  const world::TargetPhoto photo = views.photo();
  Peers peers;
  peers.push_back(gannet_single(views.rig(), photo));
  peers.push_back(opencv_features(Features::kAkaze, views.rig(), photo));
  peers.push_back(opencv_features(Features::kOrb, views.rig(), photo));
  peers.push_back(april_tag(views.rig()));
  single_views(peers, views, view_count, results);
  peers[0] = gannet_film(views.rig(), photo);
  peers.push_back(opencv_ecc(views.rig(), photo));
  auto visp = visp_template(views.rig(), photo);
  const bool has_visp = visp != nullptr;
  if (has_visp) peers.push_back(std::move(visp));
  films(peers, views, film_count, results);
  if (!has_visp) std::puts("ViSP template: skipped, built without it (libvisp-tt-dev)");
  evaluation_with_opencv(results);
  return json.empty() || results.write_json(json) ? 0 : 1;
}

}  // namespace
}  // namespace gannet::bench

int main(int argc, char** argv) {
  int views = 60, films = 3;
  std::string json, flags, commit;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    int* number = word == "--views" ? &views : word == "--films" ? &films : nullptr;
    std::string* text = word == "--json"     ? &json
                        : word == "--flags"  ? &flags
                        : word == "--commit" ? &commit
                                             : nullptr;
    if (i + 1 < argc && number != nullptr && std::atoi(argv[i + 1]) > 0) {
      *number = std::atoi(argv[++i]);
    } else if (i + 1 < argc && text != nullptr) {
      *text = argv[++i];
    } else {
      std::fputs(gannet::bench::kHelp, stderr);
      return 2;
    }
  }
  return gannet::bench::run(views, films, json, flags, commit);
}
