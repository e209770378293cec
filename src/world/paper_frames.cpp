#include "src/world/paper_frames.hpp"

#include <chrono>
#include <cmath>
#include <limits>

#include "platform/base/random.hpp"
#include "src/config/daemon_config.hpp"
#include "src/modeldb/model_file.hpp"
#include "src/report/statistics.hpp"
#include "src/track/recogniser.hpp"
#include "src/world/props.hpp"
#include "src/world/run_files.hpp"
#include "src/world/stage.hpp"

namespace gannet::world {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr int kSettlingFrames = 90;  // of the papers' method: 3 s at 30 Hz

using Column = double (*)(const FrameSample& sample);

std::vector<double> column(std::span<const FrameSample> samples, Column of) {
  std::vector<double> values;
  for (const FrameSample& sample : samples)
    if (sample.found) values.push_back(of(sample));
  return values;
}

template <int kAxis>
double absolute_mm(const FrameSample& s) {
  return 1000 * std::abs(s.place_m[kAxis] - s.truth_m[kAxis]);
}
template <int kAxis>
double place_mm(const FrameSample& s) {
  return 1000 * s.place_m[kAxis];
}
double fitness_of(const FrameSample& s) { return s.fitness; }
// Shares of the truth.
double distance(const FrameSample& s) { return s.place_m.z() / s.truth_m.z(); }
double width(const FrameSample& s) { return s.size_m.x() / s.true_size_m.x(); }
double height(const FrameSample& s) { return s.size_m.y() / s.true_size_m.y(); }

// P004's measures: |mean − truth| / truth, and standard deviation / mean; %.
double relative_error(const std::vector<double>& shares) {
  return 100 * std::abs(report::mean(shares) - 1);
}
double relative_deviation(const std::vector<double>& shares) {
  return 100 * report::standard_deviation(shares) / report::mean(shares);
}

double found_share(std::span<const FrameSample> samples) {
  if (samples.empty()) return kNothing;
  return static_cast<double>(column(samples, fitness_of).size()) /
         static_cast<double>(samples.size());
}

struct FrameMeasure {
  std::string_view name;
  Column of;
  double (*sum_up)(const std::vector<double>& values);
};
double mean(const std::vector<double>& values) { return report::mean(values); }
double deviation(const std::vector<double>& values) { return report::standard_deviation(values); }

constexpr FrameMeasure kMeasures[] = {{"abs_x_mm", absolute_mm<0>, mean},
                                      {"abs_y_mm", absolute_mm<1>, mean},
                                      {"abs_z_mm", absolute_mm<2>, mean},
                                      {"mean_z_mm", place_mm<2>, mean},
                                      {"fitness", fitness_of, mean},
                                      {"fitness_deviation", fitness_of, deviation},
                                      {"distance_re", distance, relative_error},
                                      {"distance_rsd", distance, relative_deviation},
                                      {"height_re", height, relative_error},
                                      {"height_rsd", height, relative_deviation},
                                      {"width_re", width, relative_error},
                                      {"width_rsd", width, relative_deviation}};

// The scene, its cameras and the recogniser, as the daemon of the scenario would have it.
struct Bench {
  StereoRig rig;
  Transform<World, Hand> world_from_hand;
  std::unique_ptr<Stage> stage;
  std::unique_ptr<Renderer> renderer;
  track::TrackConfig track;
  std::optional<vision::PatchModel> model;  // none: a rectangle
  std::vector<std::string> notes;

  Transform<LeftCamera, Target> truth() const {
    return rig.hand_from_left.inverse() * world_from_hand.inverse() * stage->pose(0, 0);
  }
};

Result<vision::PatchModel> model_of(const std::string& path, int points) {
  const auto photo = modeldb::load_model(path);
  if (!photo) return photo.error();
  return vision::make_patch_model(*photo, {.inside_points = points});
}

// By up to about a pixel and a half, so that seeds differ in where edges fall between pixels.
void shift(Scenario& scenario) {
  Random random(static_cast<std::uint64_t>(scenario.seed));
  std::vector<double>& place = scenario.targets.front().position_mm;
  for (const std::size_t axis : {0u, 1u})
    place[axis] += 0.0025 * place[2] * (2 * random.uniform() - 1);
}

Result<Bench> make_bench(const Scenario& scenario, const std::string& assets) {
  const auto files = RunFiles::create("");
  if (!files) return files.error();
  auto pictures = gather_pictures(scenario, assets);
  if (!pictures) return pictures.error();
  Bench bench;
  bench.rig = scenario.rig();
  bench.world_from_hand = scenario.start_pose() * *bench.rig.body_from_hand;
  bench.notes = pictures->notes;
  const auto seed = static_cast<std::uint64_t>(scenario.seed);
  bench.stage = std::make_unique<Stage>(scenario, pictures->places, seed);
  RendererConfig config;
  config.sensor = scenario.scene.sensor;
  bench.renderer =
      std::make_unique<Renderer>(bench.rig, std::move(pictures->textures), config, seed);
  Serial serial;
  const auto models =
      make_models(scenario, pictures->places, *bench.renderer, serial, files->folder());
  if (!models) return models.error();
  const auto written =
      write_files(scenario, *files, daemon_config(scenario, *files, *models, true));
  if (!written) return written.error();
  const auto loaded = config::load_daemon_config({files->config(), scenario.daemon.settings});
  if (!loaded) return loaded.error();
  bench.track = loaded->config.track;
  if (models->empty()) return bench;
  auto model = model_of(models->front(), bench.track.model_points);
  if (!model) return model.error();
  bench.model = std::move(*model);
  return bench;
}

// Where the line of sight of a left pixel meets the target's plane.
Eigen::Vector3d on_plane(const StereoRig& rig, const Transform<LeftCamera, Target>& pose, double u,
                         double v) {
  const Eigen::Vector3d normal = pose.rotation * Eigen::Vector3d::UnitZ();
  const Line sight = rig.left.line({u, v}).value_or(Line{});
  return sight.at_plane(normal, normal.dot(pose.translation));
}

// Around the target in the left image, as a person would draw it.
vision::Rectangle rectangle_around(const Bench& bench) {
  const Eigen::Vector2d half = 0.5 * bench.stage->size_m(0);
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
  for (const double x : {-half.x(), half.x()}) {
    for (const double y : {-half.y(), half.y()}) {
      const auto pixel = bench.rig.left.project(bench.truth()({x, y, 0}));
      if (!pixel) continue;
      left = std::min(left, pixel->x()), right = std::max(right, pixel->x());
      top = std::min(top, pixel->y()), bottom = std::max(bottom, pixel->y());
    }
  }
  const auto whole = [](double px) { return static_cast<int>(std::lround(px)); };
  return {whole(left), whole(top), whole(right) - whole(left) + 1, whole(bottom) - whole(top) + 1};
}

FrameSample sample_of(const Bench& bench, const track::Recognition& got,
                      const vision::Rectangle& r) {
  FrameSample sample;
  sample.found = got.found;
  sample.fitness = got.fitness;
  sample.place_m = bench.rig.hand_from_left(got.left_from_target.translation);
  const Transform<LeftCamera, Target> truth = bench.truth();
  if (bench.model) {
    sample.truth_m = bench.rig.hand_from_left(truth.translation);
    return sample;
  }
  const auto at = [&](double u, double v) { return on_plane(bench.rig, truth, u, v); };
  const double left = r.x - 0.5, right = left + r.width, top = r.y - 0.5, bottom = top + r.height;
  const double mid_u = (left + right) / 2, mid_v = (top + bottom) / 2;
  sample.truth_m = bench.rig.hand_from_left(at(mid_u, mid_v));
  sample.size_m = got.size_m;
  sample.true_size_m = {(at(right, mid_v) - at(left, mid_v)).norm(),
                        (at(mid_u, bottom) - at(mid_u, top)).norm()};
  return sample;
}

}  // namespace

double frame_measure(std::string_view name, std::span<const FrameSample> samples) {
  if (name == "found_share") return found_share(samples);
  for (const FrameMeasure& measure : kMeasures) {
    if (name != measure.name) continue;
    const std::vector<double> values = column(samples, measure.of);
    return values.empty() ? kNothing : measure.sum_up(values);
  }
  return kNothing;
}

Result<PaperResult> run_frames(const PaperRequest& request, const Scenario& scenario,
                               const PaperTick& tick) {
  const auto begin = std::chrono::steady_clock::now();
  Scenario shifted = scenario;
  shift(shifted);
  auto bench = make_bench(shifted, request.options.assets);
  if (!bench) return bench.error();
  const bool goes_on = request.method == PaperMethod::kPapers;
  const auto kind = bench->model ? track::TargetKind::kModel : track::TargetKind::kRectangle;
  if (bench->model && bench->track.fitness == "p000") bench->track.fitness = "p002";
  auto recogniser = track::Recogniser::create(bench->track, bench->rig, kind);
  if (!recogniser) return recogniser.error();
  track::Recogniser& sut = **recogniser;
  const int width = bench->rig.left.width, height = bench->rig.left.height;
  vision::PreparedFrame frame(width, height, sut.needs());
  const auto blank = [&] {
    return hal::Image(width, height, FrameSink::kFormat, FrameSink::kMatrix, FrameSink::kRange);
  };
  hal::Image left = blank(), right = blank();
  const Scene scene = bench->stage->scene(0);
  const vision::Rectangle rectangle = rectangle_around(*bench);
  const int settling = goes_on ? kSettlingFrames : 0;
  const int total = settling + request.experiment->frames;
  std::vector<FrameSample> samples;
  Serial serial;
  for (int i = 0; i < total; ++i) {
    // Caustics, snow and noise go on by the pictures' number and time.
    bench->renderer->render(scene, bench->world_from_hand * bench->rig.hand_from_left, i / 30.0,
                            static_cast<std::uint64_t>(i), serial, target_of(left),
                            target_of(right));
    frame.prepare(left.view(), right.view());
    const bool anew = i == 0 || !goes_on;
    const bool taken = !bench->model ? (anew ? sut.set_rectangle(rectangle, frame)
                                             : sut.refresh_rectangle(rectangle, frame))
                                     : !anew || sut.set_model(*bench->model);
    if (!taken) return Error{"the target is too small, or not wholly in the left image"};
    const track::Recognition got = sut.recognise(frame, nullptr, {}, serial);
    if (i >= settling) samples.push_back(sample_of(*bench, got, rectangle));
    tick(i + 1, total);
  }
  PaperResult result;
  for (const PaperFigure& figure : request.experiment->figures)
    result.values.push_back({&figure, frame_measure(figure.measure, samples)});
  result.trials = static_cast<int>(samples.size());
  result.notes = bench->notes;
  result.host_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace gannet::world
