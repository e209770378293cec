// Allocation: which thrusts make a wrench. The wish is projected on what the thrusters can reach
// (singular value decomposition of the allocation matrix, restricted to the controlled axes), then
// scaled so that its direction stays and no thruster exceeds its limits (T. I. Fossen, Handbook of
// Marine Craft Hydrodynamics and Motion Control, 2011, §12.3).
// Wrenches are (x, y, z, roll, pitch, yaw) in body axes: N, N·m. Fixed size after creation.
// Servo thread; RT safe after creation.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "src/core/pose_estimate.hpp"
#include "src/vehicle/thruster.hpp"

namespace gannet::vehicle {

class Allocation {
 public:
  static constexpr int kMaxThrusters = 16;
  using Axes = std::array<bool, 6>;
  using Thrusts = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxThrusters, 1>;

  // A controlled axis on which no thruster acts is an error. Start-up only.
  static Result<Allocation> create(const std::vector<ThrusterConfig>& thrusters,
                                   const Axes& controlled);

  struct Share {
    Thrusts thrusts;       // N, positive in the thruster's direction
    Vector6d unreachable;  // part of the wish that no thrusts make
    double scale = 1;
  };
  Share share(const Vector6d& wish) const;
  Vector6d wrench(const Thrusts& thrusts) const;  // on the controlled axes
  int size() const { return static_cast<int>(least_.size()); }
  int rank() const { return rank_; }

 private:
  using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kMaxThrusters>;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 6, 0, kMaxThrusters, 6>;
  Columns forward_;  // thrusts → wrench, zero rows where not controlled
  Rows inverse_;
  Matrix6d projector_ = Matrix6d::Zero();  // on what can be reached
  Thrusts least_, most_;
  int rank_ = 0;
};

}  // namespace gannet::vehicle
