// ClutteredScene: the tests' flat scene with other ellipses of the same kind of texture behind the
// target, before a textured ground. Exact truth and no files. Benchmarks only, one thread.
#pragma once

#include <vector>

#include "hal/camera/image.hpp"
#include "tests/support/flat_scene.hpp"

namespace gannet::bench {

using Pose = Transform<LeftCamera, Target>;

struct Pair {
  hal::Image left, right;  // YUYV, as a camera gives them
  Pose truth;
};

// What bends light on its way. A port stands 60 mm before a lens and is 15 mm thick; the camera
// behind it has as much shorter a focal length as makes targets as large in the picture.
enum class Bend { kNothing, kLens, kPort, kPortAndLens };

class ClutteredScene {
 public:
  // width × height with the focal length of 640 pixels at 640, 12 cm between the eyes.
  ClutteredScene(int width, int height, Bend bend = Bend::kNothing);

  const StereoRig& rig() const { return scene_.rig; }
  vision::PatchModel model(int inside_points) const;

  // A pose where both eyes see all of the target: z 0.45 … 0.95 m, tilts ±35°, roll ±40°.
  Pose random_pose(Random& random) const;
  Pair see(const Pose& pose, std::uint64_t seed) const;

 private:
  void bend_light(Bend bend);
  struct Other {
    test::Texture texture;
    Pose pose;
  };
  hal::Image eye(bool left, const Pose& pose, const std::vector<Other>& others,
                 std::uint64_t seed) const;
  void paint(bool left, const Other& other, const Pose& target, Random& random,
             test::Picture& picture) const;

  test::FlatScene scene_;
};

}  // namespace gannet::bench
