// PhotoScene: photographs of creatures before a ground, in water, through the simulated cameras:
// scenes that are unlike each other in ground, light, water and what lies about. Where the
// photographs are absent (`make assets`), drawn pictures stand for them. Benchmarks only, one
// thread.
#pragma once

#include <memory>
#include <vector>

#include "hal/camera/image.hpp"
#include "src/vision/patch_model.hpp"
#include "src/world/renderer.hpp"
#include "tests/bench/cluttered_scene.hpp"

namespace gannet::bench {

class PhotoScene {
 public:
  PhotoScene(int width, int height);

  const StereoRig& rig() const { return renderer_->rig(); }
  bool has_photographs() const { return has_photographs_; }
  // The targets that may be sought, each with a model as a user makes it: photo at 0.4 m in air.
  int targets() const { return static_cast<int>(models_.size()); }
  const vision::PatchModel& model(int target) const { return models_[at(target)]; }
  const Eigen::Vector2d& size_m(int target) const { return sizes_[at(target)]; }

  struct Seen {
    Pair pair;
    std::vector<bool> present;  // for each target whether it is in the scene
    bool good_light = false;    // air or pool water, 50 lx and more
  };
  // A random scene of this number: ground, water, light and three to six things, which may hide
  // each other. The target is before them all, seen by both eyes, at pair.truth.
  Seen see(std::uint64_t number, int target);

 private:
  static constexpr int kGrounds = 3;  // the first textures
  Pair render(const world::Scene& scene, const Pose& truth, std::uint64_t frame);
  world::SceneObject object(int target, const Pose& pose) const;
  world::SceneObject ground(int kind, double depth_m, double tilt_deg) const;
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  bool in_view(int target, const Pose& pose) const;
  Pose random_pose(Random& random, double nearest_m, double farthest_m) const;

  std::vector<Eigen::Vector2d> sizes_;
  std::vector<vision::PatchModel> models_;
  bool has_photographs_ = true;
  std::unique_ptr<world::Renderer> renderer_;
};

}  // namespace gannet::bench
