// Stage: the things in a scenario's water as time goes on: where targets are, what covers them,
// light and current water. Gives the renderer its scene and the checks their truth. Pure; world's
// thread alone.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "src/core/stereo_rig.hpp"
#include "src/world/motion.hpp"
#include "src/world/scenario.hpp"
#include "src/world/scene.hpp"

namespace gannet::world {

// Places in the renderer's list of textures.
struct StageTextures {
  std::vector<int> targets;  // one a target of the scenario
  int background = 0;        // repeats
  int cover = 0;             // what hides a target
};

class Stage {
 public:
  Stage(const Scenario& scenario, const StageTextures& textures, std::uint64_t seed);

  int find(std::string_view name) const;  // −1: none
  void cover(int target, bool covered) { things_[at(target)].covered = covered; }
  void set_light(double lux) { light_.lux = lux; }

  Transform<World, Target> pose(int target, double time_s) const;
  Eigen::Vector2d size_m(int target) const { return things_[at(target)].size_m; }
  Scene scene(double time_s) const;

  // Whether all corners of a target are inside both images.
  bool in_view(int target, double time_s, const StereoRig& rig,
               const Transform<World, Hand>& world_from_hand) const;

 private:
  struct Thing {
    std::string name;
    Transform<World, Target> rest;
    Motion motion;
    Eigen::Vector2d size_m;
    int texture = 0;
    bool covered = false;
  };
  static std::size_t at(int index) { return static_cast<std::size_t>(index); }

  std::vector<Thing> things_;
  SceneObject background_;
  SceneObject floor_;
  bool has_floor_ = false;
  bool has_ground_;
  int cover_texture_;
  Water water_;
  Light light_;
  Particles snow_;
};

}  // namespace gannet::world
