#include "tests/bench/workload.hpp"

#include "src/search/optimiser_kinds.hpp"
#include "src/track/search_space.hpp"
#include "src/vision/fitness_kinds.hpp"
#include "src/vision/kernel_choice.hpp"

namespace gannet::bench {
namespace {

const Pose kTruth = test::pose_at(0.06, -0.02, 0.62, 12, -18, 10);

// Every k-th of what differential evolution proposes in 6,000 evaluations.
void search(Workload& work, track::SearchSpace space, int wanted) {
  const int dimension = space.dimension();
  const auto d = static_cast<std::size_t>(dimension);
  constexpr int kEvaluations = 6000;
  const vision::Kernels& kernels = *vision::find_kernels("auto");
  const auto fitness =
      vision::make_fitness("gannet", work.target().unscaled, work.rig, kernels).value();
  const auto optimiser = search::make_optimiser("differential_evolution", dimension, {}, 5).value();
  vision::Scratch scratch(track::Recogniser::max_points());
  std::vector<float> genes(64 * d), scores(64);
  optimiser->begin_frame({});
  const int step = std::max(1, kEvaluations / wanted);
  for (int done = 0; static_cast<int>(work.candidates.size()) < wanted;) {
    const int n = optimiser->propose(genes);
    for (int i = 0; i < n; ++i, ++done) {
      const auto at = static_cast<std::size_t>(i);
      const vision::Hypothesis q = space.decode({genes.data() + at * d, d});
      fitness->score(work.target(), *work.frame, 0, {&q, 1}, {&scores[at], 1}, scratch);
      if (done % step == 0 && static_cast<int>(work.candidates.size()) < wanted) {
        work.candidates.push_back(q);
      }
    }
    optimiser->learn({scores.data(), static_cast<std::size_t>(n)});
  }
}

void find_cells(Workload& work) {
  const vision::CameraModel left(work.rig.left, nullptr);
  const vision::CameraModel right(work.rig.right, &work.rig.right_from_left);
  const vision::Kernels& kernels = vision::kScalarKernels;
  const vision::PointSet& set = work.points();
  const auto cells = [&](const vision::CameraModel& camera, const vision::Hypothesis& q) {
    const vision::PackedPlane& plane = work.frame->right().packed[0];
    EyeCells out;
    out.view = work.target().unscaled
                   ? camera.ray_view(q, set.reach, 0, plane.width, plane.height, plane.guard)
                   : camera.view(q, set.reach, 0, plane.width, plane.height, plane.guard);
    out.index.resize(static_cast<std::size_t>(set.total_padded));
    out.visible = camera.project(kernels, set.x.data(), set.y.data(), set.total_padded, out.view, 0,
                                 out.index.data());
    return out;
  };
  for (const vision::Hypothesis& q : work.candidates) {
    work.poses.push_back(q.pose());
    if (!work.target().unscaled) work.left.push_back(cells(left, q));
    work.right.push_back(cells(right, q));
  }
}

Workload start(const ClutteredScene& scene, track::TargetKind kind, bool brown) {
  Workload work;
  work.rig = scene.rig();
  if (brown) {
    for (Intrinsics* camera : {&work.rig.left, &work.rig.right}) {
      camera->distortion = Distortion::kBrown;
      camera->coefficients = {-0.12, 0.03, 0.0005, -0.0003, 0};
    }
  }
  work.frame = std::make_unique<vision::PreparedFrame>(
      work.rig.left.width, work.rig.left.height,
      vision::PlaneNeeds{.packed = true, .hue_value = true});
  const Pair pair = scene.see(kTruth, 3);
  work.frame->prepare(pair.left.view(), pair.right.view());
  track::TrackConfig config;
  if (kind == track::TargetKind::kRectangle) config.fitness = "p000";  // with its outer band
  work.recogniser = track::Recogniser::create(config, work.rig, kind).value();
  return work;
}

}  // namespace

Workload model_workload(const ClutteredScene& scene, int inside_points, int candidates,
                        bool brown) {
  Workload work = start(scene, track::TargetKind::kModel, brown);
  work.recogniser->set_model(scene.model(inside_points));
  search(work, track::SearchSpace(work.rig, {}), candidates);
  find_cells(work);
  return work;
}

Workload rectangle_workload(const ClutteredScene& scene, int candidates) {
  Workload work = start(scene, track::TargetKind::kRectangle, false);
  const Eigen::Vector2d centre = work.rig.left.project(kTruth.translation).value();
  const int half = work.rig.left.width / 14;
  const vision::Rectangle r = {static_cast<int>(centre.x()) - half,
                               static_cast<int>(centre.y()) - half * 2 / 3, 2 * half + 1,
                               half * 4 / 3 + 1};
  work.recogniser->set_rectangle(r, *work.frame);
  track::SearchSpace space(work.rig, {});
  space.fix_ray(work.rig.left.ray({r.x + (r.width - 1) / 2.0, r.y + (r.height - 1) / 2.0}));
  search(work, space, candidates);
  find_cells(work);
  return work;
}

}  // namespace gannet::bench
