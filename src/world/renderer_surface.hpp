// One flat thing as one camera sees it: rays through pixels (RayTable) meet its plane, the texture
// is looked up where they do, filtered over the pixel's footprint, lit, seen through the water and
// laid over what is there. Used by the renderer only, on any thread of its; made anew for every
// picture, no heap.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "src/core/stereo_rig.hpp"
#include "src/world/scene.hpp"
#include "src/world/texture.hpp"
#include "src/world/water.hpp"

namespace gannet::world {

// The rays (x, y, 1) through all pixels of a camera, distortion included, and one column and row
// more, for differences. Made once. The pinhole takes the same road: the table costs no more than
// its arithmetic.
class RayTable {
 public:
  explicit RayTable(const Intrinsics& camera);
  const float* x(int row) const { return x_.data() + at(row); }
  const float* y(int row) const { return y_.data() + at(row); }

 private:
  std::size_t at(int row) const { return static_cast<std::size_t>(row) * columns_; }
  std::size_t columns_;
  std::vector<float> x_, y_;
};

// Moving nets of light on everything that the sun meets.
struct Caustics {
  const Texture* pattern = nullptr;  // mean 0.25, tiled
  float strength = 0;
  float per_metre = 0;
  float shift[2][2] = {};  // of the two layers, in tiles
};

class Surface {
 public:
  // camera_from_object: where it stands; shade: light on it, R, G, B.
  Surface(const SceneObject& object, const Texture& texture, const Eigen::Quaterniond& rotation,
          const Eigen::Vector3d& translation, const Intrinsics& camera, const Float4& shade);

  void set_caustics(const Caustics& caustics, const SceneObject& object);
  double distance_m() const { return distance_m_; }
  int first_row() const { return first_row_; }
  int end_row() const { return end_row_; }

  // Lays itself over one row of pixels; `out` has the camera's width. lanes: R, G, B, alpha.
  void draw_row(const RayTable& rays, int row, const WaterTable& water, Float4* out) const;

  // Depth along z where a ray (x, y, 1) meets something opaque of it, 0 if it does not.
  float opaque_depth(float x, float y) const;

 private:
  // The pixel's footprint in the texture; linear between nodes 16 pixels apart, so continuous.
  struct Footprint {
    Float4 filter;  // level by the short side; number of probes along the long side; its u, v
    Float4 edge;    // |∇u|, |∇v| for one pixel: how soft the border is
  };
  struct Hit {
    float u, v, depth;
  };
  Hit hit(float x, float y) const {
    const float inverse = 1.0f / ((nx_ * x + ny_ * y) + nz_);
    return {((ux_ * x + uy_ * y) + uz_) * inverse, ((vx_ * x + vy_ * y) + vz_) * inverse,
            c_ * inverse};
  }
  Footprint footprint(const RayTable& rays, int column, int row) const;
  Float4 look(Float4 place, float level) const;
  Float4 filtered(float u, float v, Float4 filter) const;
  static float border(float u, float v, Float4 edge);
  float gathered(float u, float v) const;
  void draw_run(const float* x, const float* y, int count, const Footprint& a, const Footprint& b,
                const WaterTable& water, Float4* out) const;
  void bound(const SceneObject& object, const Eigen::Quaterniond& rotation,
             const Eigen::Vector3d& translation, const Intrinsics& camera);

  const Texture* texture_;
  bool tiled_;
  Float4 shade_;
  Caustics caustics_;
  float world_[2][3] = {};  // pattern's x, y of (u, v, 1)
  double distance_m_;
  float ux_, uy_, uz_, vx_, vy_, vz_, nx_, ny_, nz_, c_;
  int first_column_ = 0, end_column_ = 0, first_row_ = 0, end_row_ = 0;
  int columns_ = 0;
};

}  // namespace gannet::world
