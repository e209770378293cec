#include "src/world/fitness_maps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "platform/linux/whole_file.hpp"
#include "src/image_file/drawing.hpp"
#include "src/image_file/jpeg.hpp"
#include "src/image_file/png.hpp"
#include "src/modeldb/model_file.hpp"
#include "src/report/html_report.hpp"
#include "src/track/recogniser.hpp"
#include "src/world/album.hpp"
#include "src/world/assets.hpp"
#include "src/world/props.hpp"

namespace gannet::world {
namespace {

using Pose = Transform<LeftCamera, Target>;

const Eigen::Vector3d kTruth_m(0, 0, 0.5);  // of Σ_H
constexpr int kHalfWidth = 40, kHalfHeight = 30;
constexpr double kElsewhere_mm = 50;
constexpr std::array<const char*, 2> kFitnesses = {"gannet", "p001"};

struct View {
  hal::Image left, right;
};

class Portraits {
 public:
  Portraits(const Scenario& scenario, const StageTextures& places, Renderer& renderer,
            Parallel& parallel)
      : scenario_(scenario), places_(places), renderer_(renderer), parallel_(parallel) {}

  Pose truth() const { return {Eigen::Quaterniond::Identity(), in_left(kTruth_m)}; }

  // The target squarely before the cameras, above the bottom; the others around it, a little
  // farther away, so that nothing of it is hidden.
  View see(std::size_t target, bool among_others, std::uint64_t number) const {
    constexpr double kBottom_m = 1.6, kFarther_m = 0.08;
    constexpr std::array<std::array<double, 2>, 4> kAround = {
        {{-0.15, -0.1}, {0.15, -0.1}, {-0.15, 0.1}, {0.15, 0.1}}};
    Scene scene;
    scene.water = pool_water();
    SceneObject bottom = object(places_.background, {30, 30}, {0, 0, kBottom_m});
    bottom.tile_m = kBottomTile_m;
    scene.background.push_back(bottom);
    for (std::size_t i = 0; among_others && i < kAround.size(); ++i) {
      // Each from its side of the album: two models a creature.
      const std::size_t other = (target + 2 * (i + 1)) % kModels;
      const Eigen::Vector3d at(kAround[i][0], kAround[i][1], kTruth_m.z() + kFarther_m);
      scene.objects.push_back(object(places_.targets[other], size_of(other), at));
    }
    scene.objects.push_back(object(places_.targets[target], size_of(target), kTruth_m));
    const Intrinsics& camera = renderer_.rig().left;
    View view = {hal::Image(camera.width, camera.height, hal::PixelFormat::kYuyv),
                 hal::Image(camera.width, camera.height, hal::PixelFormat::kYuyv)};
    renderer_.render(scene, Transform<World, LeftCamera>::identity(), 0, number, parallel_,
                     world::target_of(view.left), world::target_of(view.right));
    return view;
  }

  static constexpr std::size_t kModels = 12;

 private:
  Eigen::Vector3d in_left(const Eigen::Vector3d& in_hand) const {
    return renderer_.rig().hand_from_left.inverse()(in_hand);
  }
  Eigen::Vector2d size_of(std::size_t target) const {
    const auto& size_mm = scenario_.targets[target].size_mm;
    return {size_mm[0] / 1000, size_mm[1] / 1000};
  }
  SceneObject object(int texture, const Eigen::Vector2d& size_m, const Eigen::Vector3d& at) const {
    SceneObject out;
    out.texture = texture;
    out.size_m = size_m;
    out.pose = Transform<World, LeftCamera>::identity() *
               Pose{Eigen::Quaterniond::Identity(), in_left(at)};
    return out;
  }

  const Scenario& scenario_;
  const StageTextures& places_;
  Renderer& renderer_;
  Parallel& parallel_;
};

// Scores one model in one view.
Result<FitnessMap> map_of(const vision::PatchModel& model, const std::string& fitness,
                          const StereoRig& rig, const View& view, const Pose& truth,
                          Parallel& parallel) {
  track::TrackConfig config;
  config.fitness = fitness;
  auto recogniser = track::Recogniser::create(config, rig, track::TargetKind::kModel);
  if (!recogniser) return recogniser.error();
  if (!(*recogniser)->set_model(model)) return Error{model.name + ": too many points"};
  vision::PreparedFrame frame(rig.left.width, rig.left.height, (*recogniser)->needs());
  frame.prepare(view.left.view(), view.right.view());
  FitnessMap map;
  map.model = model.name;
  map.fitness = fitness;
  map.width = 2 * kHalfWidth + 1;
  map.height = 2 * kHalfHeight + 1;
  std::vector<vision::Hypothesis> row;
  std::vector<float> scores(static_cast<std::size_t>(map.width));
  for (int y = -kHalfHeight; y <= kHalfHeight; ++y) {
    row.clear();
    for (int x = -kHalfWidth; x <= kHalfWidth; ++x) {
      Pose pose = truth;
      pose.translation += Eigen::Vector3d(x, y, 0) * (kMapStep_mm / 1000);
      row.push_back(vision::Hypothesis::from(pose));
    }
    (*recogniser)->score(frame, row, scores, parallel);
    map.scores.insert(map.scores.end(), scores.begin(), scores.end());
  }
  return map;
}

std::string words_of(const FitnessMap& map) {
  const MapPeak peak = peak_of(map);
  return map.fitness + ": " + report::number(peak.score, 3) + " at " +
         report::number(peak.off_mm, 1) + " mm from the truth, " +
         report::number(peak.elsewhere, 3) + " at most elsewhere";
}

Result<void> add_to_page(report::HtmlReport& page, const View& view,
                         const std::vector<FitnessMap>& maps) {
  constexpr int kScale = 4;
  page.begin_row();
  const auto left = image_file::encode_jpeg(view.left.view(), 85);
  if (!left) return left.error();
  if (auto added = page.picture(*left, "left eye"); !added) return added;
  for (const FitnessMap& map : maps) {
    const auto [low, high] = std::minmax_element(map.scores.begin(), map.scores.end());
    const auto picture = image_file::encode_png(
        image_file::heat_map(map.scores, map.width, map.height, *low, *high, kScale).view());
    if (!picture) return picture.error();
    if (auto added = page.picture(*picture, words_of(map)); !added) return added;
  }
  page.end_row();
  return {};
}

Result<void> write_peaks(const std::string& path, const std::vector<FitnessMap>& maps) {
  std::string text = "model,among_others,fitness,off_mm,score,elsewhere\n";
  for (const FitnessMap& map : maps) {
    const MapPeak peak = peak_of(map);
    text += map.model + "," + (map.among_others ? "yes," : "no,") + map.fitness + "," +
            report::number(peak.off_mm, 2) + "," + report::number(peak.score, 5) + "," +
            report::number(peak.elsewhere, 5) + "\n";
  }
  return linux_os::write_file(path, text);
}

}  // namespace

MapPeak peak_of(const FitnessMap& map) {
  MapPeak peak{0, -INFINITY, -INFINITY};
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const double score = map.scores[static_cast<std::size_t>(y * map.width + x)];
      const double off_mm = kMapStep_mm * std::hypot(x - map.width / 2, y - map.height / 2);
      if (score > peak.score) peak.score = score, peak.off_mm = off_mm;
      if (off_mm > kElsewhere_mm) peak.elsewhere = std::max(peak.elsewhere, score);
    }
  }
  return peak;
}

Result<std::vector<FitnessMap>> make_fitness_maps(const std::string& folder,
                                                  const std::string& assets, std::uint64_t seed,
                                                  Parallel& parallel) {
  const Scenario scenario = album_scenario();
  auto pictures = gather_pictures(scenario, assets);
  if (!pictures) return pictures.error();
  Renderer renderer(scenario.rig(), std::move(pictures->textures), {}, seed);
  const Portraits portraits(scenario, pictures->places, renderer, parallel);
  report::HtmlReport page(
      "Fitness over x and y",
      "As P001 Fig. 6: each model at [0, 0, 500] mm, scored every 5 mm over ±200 × ±150 mm with "
      "depth and orientation true. Bright is fit; each map has its own range of colours. gannet: "
      "the default fitness; p001: the paper's.");
  for (const std::string& note : pictures->notes) page.paragraph(note);
  std::vector<FitnessMap> all;
  std::uint64_t number = seed;
  for (std::size_t i = 0; i < Portraits::kModels; ++i) {
    const std::string& name = scenario.targets[i].name;
    const auto patch = modeldb::load_model(folder + "/models/" + name + ".gannet");
    if (!patch) return patch.error();
    const auto model = vision::make_patch_model(*patch, {});
    if (!model) return model.error();
    for (const bool among_others : {false, true}) {
      page.subheading(name + (among_others ? ", among others" : ", alone"));
      const View view = portraits.see(i, among_others, ++number);
      std::vector<FitnessMap> maps;
      for (const char* fitness : kFitnesses) {
        auto map = map_of(*model, fitness, renderer.rig(), view, portraits.truth(), parallel);
        if (!map) return map.error();
        map->among_others = among_others;
        maps.push_back(std::move(*map));
      }
      if (auto added = add_to_page(page, view, maps); !added) return added.error();
      all.insert(all.end(), maps.begin(), maps.end());
    }
  }
  if (auto written = page.write(folder + "/maps.html"); !written) return written.error();
  if (auto written = write_peaks(folder + "/maps.csv", all); !written) return written.error();
  return all;
}

}  // namespace gannet::world
