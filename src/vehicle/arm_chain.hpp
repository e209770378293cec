// ArmChain: a serial chain of revolute joints from Denavit–Hartenberg parameters: where the body
// (Σ_B, on the last link) is, and how it moves with the joints. Frame i at the end of link i:
//   A_i = Rz(θ_i + q_i) · Tz(d_i) · Tx(a_i) · Rx(α_i)
// Jacobian (B. Siciliano et al., "Robotics: Modelling, Planning and Control", 2009, Eq. 3.30):
// column i = (z_i × (p − p_i), z_i), here turned into Σ_B. Radians, metres. A value; RT safe.
#pragma once

#include <Eigen/Core>

#include "src/core/pose_estimate.hpp"
#include "src/core/transform.hpp"
#include "src/vehicle/arm_config.hpp"

namespace gannet::vehicle {

struct ArmBase {};  // the arm's foot: z is the first joint's axis

using Joints = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxJoints, 1>;
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kMaxJoints>;

class ArmChain {
 public:
  // As create_vehicle checks it: 1 … kMaxJoints joints.
  explicit ArmChain(const ArmConfig& config);

  int size() const { return static_cast<int>(a_.size()); }
  Transform<ArmBase, Body> base_from_body(const Joints& angles) const;
  // Twist of the body in its own frame (linear, angular) = J(q)·q̇.
  Jacobian jacobian(const Joints& angles) const;

 private:
  struct Link {};
  Transform<Link, Link> link(int i, double angle) const;

  Joints a_, d_, alpha_, theta_;
  Transform<Link, Body> link_from_body_;
};

}  // namespace gannet::vehicle
