#include "src/world/album.hpp"

#include <array>
#include <cstdio>
#include <filesystem>

#include "platform/base/random.hpp"
#include "platform/linux/whole_file.hpp"
#include "src/config/rig_file.hpp"
#include "src/image_file/image_file.hpp"
#include "src/world/assets.hpp"
#include "src/world/props.hpp"

namespace gannet::world {
namespace {

constexpr std::array<const char*, 6> kOfP001 = {"seahorse",  "coelacanth", "dolphin",
                                                "jellyfish", "crab_p001",  "squid"};
constexpr std::array<const char*, 2> kOthers = {"lobster", "starfish"};
constexpr double kRadians = 3.14159265358979323846 / 180;
constexpr double kGround_m = 1.6;

TargetScenario target_of(const std::string& name, const std::string& creature, bool known) {
  TargetScenario target;
  target.name = name;
  target.texture = creature + (name.ends_with("_right") ? " mirrored" : "");
  const Creature& look = *find_creature(creature);
  target.size_mm = {1000 * look.width_m, 1000 * look.height_m};
  target.known = known;
  return target;
}

using Pose = Transform<LeftCamera, Target>;

bool sees_all(const StereoRig& rig, const Pose& pose, const Eigen::Vector2d& size_m) {
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      const Eigen::Vector3d at = pose({x * size_m.x(), y * size_m.y(), 0});
      const auto left = rig.left.project(at), right = rig.right.project(rig.right_from_left(at));
      for (const auto& pixel : {left, right})
        if (!pixel || pixel->minCoeff() < 0 || pixel->x() > rig.left.width - 1 ||
            pixel->y() > rig.left.height - 1)
          return false;
    }
  }
  return true;
}

double between(Random& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

Pose random_pose(Random& random, double near_m, double far_m) {
  constexpr double kTilt = 30 * kRadians, kRoll = 35 * kRadians;
  const double z = between(random, near_m, far_m);
  const double x = between(random, -0.45, 0.55) * z, y = between(random, -0.35, 0.35) * z;
  const double rx = between(random, -kTilt, kTilt), ry = between(random, -kTilt, kTilt);
  return {quaternion_from_rpy(rx, ry, between(random, -kRoll, kRoll)), {x, y, z}};
}

Pose pose_in_view(Random& random, const StereoRig& rig, const Eigen::Vector2d& size_m) {
  constexpr double kNear_m = 0.45, kFar_m = 0.8;
  Pose pose;
  do {
    pose = random_pose(random, kNear_m, kFar_m);
  } while (!sees_all(rig, pose, size_m));
  return pose;
}

class Studio {
 public:
  Studio(const Scenario& scenario, const Pictures& pictures, Renderer& renderer, Parallel& parallel)
      : scenario_(scenario), places_(pictures.places), renderer_(renderer), parallel_(parallel) {}

  // One pair of pictures into the folder, and its row of the table.
  Result<std::string> take(int number, Random& random, const std::string& folder) {
    constexpr std::array<double, 3> kLux = {400, 50, 5};
    constexpr std::size_t kModels = 2 * kOfP001.size(), kTurns = kModels + 1;
    const auto which = static_cast<std::size_t>(number) % kTurns;
    Scene scene;
    scene.water = pool_water();
    scene.light.lux = kLux[static_cast<std::size_t>(number) / kTurns % kLux.size()];
    SceneObject ground = object(places_.background, {30, 30}, {});
    ground.pose = kWorldFromLeft * Pose{Eigen::Quaterniond::Identity(), {0, 0, kGround_m}};
    ground.tile_m = kBottomTile_m;
    scene.background.push_back(ground);
    std::string name = "none";
    Pose truth;
    if (which < kModels) {
      name = scenario_.targets[which].name;
      truth = pose_in_view(random, renderer_.rig(), size_of(which));
      scene.objects.push_back(object(places_.targets[which], size_of(which), truth));
    }
    for (std::size_t i = kModels; i < scenario_.targets.size(); ++i) {
      constexpr double kNear_m = 1.0, kFar_m = 1.3;  // behind all of what is sought
      scene.objects.push_back(
          object(places_.targets[i], size_of(i), random_pose(random, kNear_m, kFar_m)));
    }
    return write(number, scene, name, truth, folder);
  }

 private:
  static inline const Transform<World, LeftCamera> kWorldFromLeft =
      Transform<World, LeftCamera>::identity();

  Eigen::Vector2d size_of(std::size_t target) const {
    const auto& size_mm = scenario_.targets[target].size_mm;
    return {size_mm[0] / 1000, size_mm[1] / 1000};
  }
  SceneObject object(int texture, const Eigen::Vector2d& size_m, const Pose& pose) const {
    SceneObject out;
    out.texture = texture;
    out.pose = kWorldFromLeft * pose;
    out.size_m = size_m;
    return out;
  }

  Result<std::string> write(int number, const Scene& scene, const std::string& name,
                            const Pose& truth, const std::string& folder) {
    const Intrinsics& camera = renderer_.rig().left;
    hal::Image left(camera.width, camera.height, hal::PixelFormat::kYuyv);
    hal::Image right = left;
    renderer_.render(scene, kWorldFromLeft, 0, static_cast<std::uint64_t>(number) + 2, parallel_,
                     world::target_of(left), world::target_of(right));
    char frame[16], row[160];
    std::snprintf(frame, sizeof frame, "%04d", number);
    for (const bool is_left : {true, false}) {
      const std::string path = folder + (is_left ? "/left/" : "/right/") + frame + ".png";
      const auto written = image_file::write_png(path, (is_left ? left : right).view());
      if (!written) return written.error();
    }
    const Eigen::Vector3d& t = truth.translation;
    std::snprintf(row, sizeof row, "%s,%s,%.0f,%.6f,%.6f,%.6f\n", frame, name.c_str(),
                  scene.light.lux, t.x(), t.y(), t.z());
    return std::string(row);
  }

  const Scenario& scenario_;
  const StageTextures& places_;
  Renderer& renderer_;
  Parallel& parallel_;
};

Result<void> make_folders(const std::string& folder, int pairs) {
  std::error_code error;
  for (const char* below : {"/models", "/pairs/left", "/pairs/right"}) {
    if (below != std::string("/models") && pairs <= 0) continue;
    std::filesystem::create_directories(folder + below, error);
    if (error) return Error{folder + below + ": " + error.message()};
  }
  return {};
}

}  // namespace

Scenario album_scenario() {
  Scenario scenario;
  for (const char* creature : kOfP001)
    for (const char* side : {"_left", "_right"})
      scenario.targets.push_back(target_of(std::string(creature) + side, creature, true));
  for (const char* creature : kOthers)
    scenario.targets.push_back(target_of(creature, creature, false));
  return scenario;
}

Result<Album> make_album(const std::string& folder, const std::string& assets, int pairs,
                         std::uint64_t seed, Parallel& parallel) {
  const Scenario scenario = album_scenario();
  if (auto made = make_folders(folder, pairs); !made) return made.error();
  const StereoRig rig = scenario.rig();
  if (auto written = linux_os::write_file(folder + "/rig.toml", config::rig_text(rig)); !written)
    return written.error();
  auto pictures = gather_pictures(scenario, assets);
  if (!pictures) return pictures.error();
  Renderer renderer(rig, std::move(pictures->textures), {}, seed);
  const auto models =
      make_models(scenario, pictures->places, renderer, parallel, folder + "/models");
  if (!models) return models.error();
  Random random(seed);
  Studio studio(scenario, *pictures, renderer, parallel);
  std::string table = "frame,model,lux,x_m,y_m,z_m\n";
  for (int i = 0; i < pairs; ++i) {
    const auto row = studio.take(i, random, folder + "/pairs");
    if (!row) return row.error();
    table += *row;
  }
  if (pairs > 0) {
    if (auto written = linux_os::write_file(folder + "/pairs/truth.csv", table); !written)
      return written.error();
  }
  return Album{pictures->notes, static_cast<int>(models->size())};
}

}  // namespace gannet::world
