// One flat thing as one camera sees it: lines of sight through pixels (SightTable) meet its plane,
// the texture is looked up where they do, filtered over the pixel's footprint, lit, seen through
// the water and laid over what is there. Used by the renderer only, on any thread of its; made anew
// for every picture, no heap.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "src/core/stereo_rig.hpp"
#include "src/world/scene.hpp"
#include "src/world/texture.hpp"
#include "src/world/water.hpp"

namespace gannet::world {

// One line of sight: direction (x, y, 1), from the camera's centre; behind a port (exactly, by
// src/core/flat_port.hpp) from `from` metres along the port's axis, which all lines meet.
struct Sight {
  float x, y, from;
};
Sight sight_of(const Intrinsics& camera, const Eigen::Vector2d& pixel);

// The lines of sight of all pixels of a camera, distortion and port included, and one column and
// row more, for differences. Made once. The pinhole takes the same road: the table costs no more
// than its arithmetic.
class SightTable {
 public:
  explicit SightTable(const Intrinsics& camera);
  struct Run {
    const float *x, *y, *from;
    Sight operator[](int i) const { return {x[i], y[i], from == nullptr ? 0 : from[i]}; }
  };
  Run run(int column, int row) const {
    const std::size_t at =
        static_cast<std::size_t>(row) * columns_ + static_cast<std::size_t>(column);
    return {x_.data() + at, y_.data() + at, from_.empty() ? nullptr : from_.data() + at};
  }

 private:
  std::size_t columns_;
  std::vector<float> x_, y_, from_;  // from_ is empty without a port
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
  void draw_row(const SightTable& sights, int row, const WaterTable& water, Float4* out) const;

  // Depth along z where a line of sight meets something opaque of it, 0 if it does not.
  float opaque_depth(const Sight& sight) const;

 private:
  // The pixel's footprint in the texture; linear between nodes 16 pixels apart, so continuous.
  struct Footprint {
    Float4 filter;  // level by the short side; number of probes along the long side; its u, v
    Float4 edge;    // |∇u|, |∇v| for one pixel: how soft the border is
  };
  struct Hit {
    float u, v, depth;
  };
  Hit hit(const Sight& s) const {
    const float inverse = 1.0f / ((nx_ * s.x + ny_ * s.y) + nz_);
    const Hit straight = {((ux_ * s.x + uy_ * s.y) + uz_) * inverse,
                          ((vx_ * s.x + vy_ * s.y) + vz_) * inverse, c_ * inverse};
    return has_port_ ? moved(straight, s, inverse) : straight;
  }
  Hit moved(const Hit& straight, const Sight& s, float inverse) const {
    const float by = s.from * inverse;
    return {straight.u + ((port_u_[0] * s.x + port_u_[1] * s.y) + port_u_[2]) * by,
            straight.v + ((port_v_[0] * s.x + port_v_[1] * s.y) + port_v_[2]) * by,
            straight.depth + ((port_z_[0] * s.x + port_z_[1] * s.y) + port_z_[2]) * by};
  }
  Footprint footprint(const SightTable& sights, int column, int row) const;
  Float4 look(Float4 place, float level) const;
  Float4 filtered(float u, float v, Float4 filter) const;
  static float border(float u, float v, Float4 edge);
  float gathered(float u, float v) const;
  void draw_run(const SightTable::Run& sights, int count, const Footprint& a, const Footprint& b,
                const WaterTable& water, Float4* out) const;
  void set_port(const FlatPort& port, const Eigen::Matrix3d& r, double w, double h);
  void bound(const SceneObject& object, const Eigen::Quaterniond& rotation,
             const Eigen::Vector3d& translation, const Intrinsics& camera);

  const Texture* texture_;
  bool tiled_;
  Float4 shade_;
  Caustics caustics_;
  float world_[2][3] = {};  // pattern's x, y of (u, v, 1)
  double distance_m_;
  bool has_port_ = false;
  float port_u_[3] = {}, port_v_[3] = {}, port_z_[3] = {};  // what a metre of `from` adds
  float dry_m_ = 0;                                         // housing before the water begins
  float ux_, uy_, uz_, vx_, vy_, vz_, nx_, ny_, nz_, c_;
  int first_column_ = 0, end_column_ = 0, first_row_ = 0, end_row_ = 0;
  int columns_ = 0;
};

}  // namespace gannet::world
