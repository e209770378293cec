// What the peers look at: a flat textured square before a wall, and an AprilTag of the same size in
// its place, in the simulated world's light and water. Exact truth, no files; single views at
// random poses and short films with small motion. Benchmarks only, one thread.
#pragma once

#include <cstdint>
#include <vector>

#include "platform/base/random.hpp"
#include "src/world/assets.hpp"
#include "src/world/renderer.hpp"

namespace gannet::bench {

using Pose = Transform<LeftCamera, Target>;

inline constexpr double kSide_m = 0.14;       // of the target, and of the tag with its white margin
inline constexpr double kPhotoRange_m = 0.4;  // where the photo is taken

struct Condition {
  const char* name;
  double lux;
  bool turbid;
  double hidden;  // share of the target behind a board, from the side that is nearer
};

struct View {
  hal::Image left, right;  // YUYV, 640 × 480
  Pose truth;
};

// A pose that both eyes see all of: z 0.4 … 0.9 m, tilts ±35°, roll ±40°.
Pose random_pose(const StereoRig& rig, Random& random);

// The i-th of a film's poses about its middle: up to 6 mm, 4 mm in z and 1.2° from one to the next.
Pose pose_in_film(const Pose& middle, int i);

class Views {
 public:
  explicit Views(const image_file::Raster8& tag);

  const StereoRig& rig() const { return renderer_.rig(); }
  world::TargetPhoto photo();  // in air at 400 lx
  View see(const Condition& condition, bool tag, const Pose& pose, std::uint64_t number);

 private:
  world::Renderer renderer_;
};

}  // namespace gannet::bench
