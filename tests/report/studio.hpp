// Studio: the scenes of the robustness report, drawn by the world's renderer: a creature at a pose
// that is known exactly, under given conditions, before others of its kind and a bottom of gravel.
// Its photo-models are made as a user makes them. Same seed, same bits. Report only; one thread for
// each object.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "platform/base/random.hpp"
#include "src/vision/patch_model.hpp"
#include "src/world/props.hpp"
#include "tests/report/conditions.hpp"

namespace gannet::robustness {

using Pose = Transform<LeftCamera, Target>;

// What all studios share.
struct Cast {
  StereoRig rig;
  std::vector<world::Texture> textures;
  world::StageTextures places;
  std::vector<Eigen::Vector2d> size_m;
  std::vector<vision::PatchModel> models;  // of each creature
  std::vector<std::string> notes;          // what is a stand-in or drawn
};
// assets: the folder of photographs. Model files are left in `folder`. Error: names the file.
Result<Cast> make_cast(const std::string& assets, const std::string& folder);

// A scene, and what is sought in it: there unless shown without.
struct Staged {
  int creature = 0;
  Pose truth;
  world::Scene scene;
};
enum class Show { kTarget, kDistractorsAlone };
// Whether both cameras see the whole target, whatever may be before it.
bool sees_all(const Cast& cast, const Staged& staged);

struct Shot {
  int creature = 0;
  Pose truth;
  hal::Image left, right;
};

class Studio {
 public:
  Studio(const Cast& cast, std::uint64_t seed) : cast_(cast), seed_(seed) {}

  // Trials take turns with the creatures. number is the trial's own among all cells' and gives its
  // dice and noise: trials are independent, also those of different cells.
  Shot take(const Conditions& conditions, int trial, int number);

  // The same in two steps, for what moves in between. number of shoot() gives the noise.
  Staged stage(const Conditions& conditions, int trial, int number, Show show) const;
  Shot shoot(const Staged& staged, double blur_px, int number);

 private:
  Pose pose_in_view(Random& random, const Conditions& conditions, int creature) const;
  world::SceneObject object(int creature, const Pose& pose) const;
  void add_distractors(Random& random, const Conditions& conditions, Staged& staged) const;
  void add_cover(Random& random, double share, Staged& staged) const;

  const Cast& cast_;
  const std::uint64_t seed_;
  double blur_px_ = 0;
  std::unique_ptr<world::Renderer> renderer_;
};

}  // namespace gannet::robustness
