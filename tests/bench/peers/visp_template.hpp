// ViSP's template tracker behind plain values: its headers are C++17 and no C++20, so that what
// includes them cannot include ours. Benchmarks only, one thread.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>

namespace gannet::bench {

class VispTemplate {
 public:
  // A grey picture and in it the template: a square of 2 half_px about (cx, cy). Null: built
  // without ViSP.
  static std::unique_ptr<VispTemplate> create(const std::uint8_t* grey, int width, int height,
                                              double cx, double cy, double half_px);
  virtual ~VispTemplate() = default;
  // Where the next search starts: a homography, pixels of the frame from pixels of the picture.
  virtual void start_at(const Eigen::Matrix3d& frame_from_picture) = 0;
  // Bytes of grey, step apart. Nothing: ViSP says that it lost the template.
  virtual std::optional<Eigen::Matrix3d> track(const std::uint8_t* grey, int step) = 0;
};

}  // namespace gannet::bench
