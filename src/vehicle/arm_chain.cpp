#include "src/vehicle/arm_chain.hpp"

#include <numbers>

namespace gannet::vehicle {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;

}  // namespace

ArmChain::ArmChain(const ArmConfig& config) {
  const std::vector<JointConfig> joints = joints_of(config);
  const auto n = static_cast<Eigen::Index>(joints.size());
  for (Joints* values : {&a_, &d_, &alpha_, &theta_}) values->resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const JointConfig& joint = joints[static_cast<std::size_t>(i)];
    a_[i] = joint.a_m;
    d_[i] = joint.d_m;
    alpha_[i] = joint.alpha_deg * kDegree;
    theta_[i] = joint.theta_deg * kDegree;
  }
  const auto& p = config.body_position_m;
  const auto& t = config.body_turn_deg;
  link_from_body_ = {quaternion_from_rpy(t[0] * kDegree, t[1] * kDegree, t[2] * kDegree),
                     {p[0], p[1], p[2]}};
}

Transform<ArmChain::Link, ArmChain::Link> ArmChain::link(int i, double angle) const {
  const Eigen::Quaterniond turn(AngleAxisd(theta_[i] + angle, Vector3d::UnitZ()));
  return {turn * AngleAxisd(alpha_[i], Vector3d::UnitX()),
          turn * Vector3d(a_[i], 0, 0) + Vector3d(0, 0, d_[i])};
}

Transform<ArmBase, Body> ArmChain::base_from_body(const Joints& angles) const {
  Transform<Link, Link> at;
  for (int i = 0; i < size(); ++i) at = at * link(i, angles[i]);
  const Transform<Link, Body> body = at * link_from_body_;
  return {body.rotation, body.translation};
}

Jacobian ArmChain::jacobian(const Joints& angles) const {
  const Transform<ArmBase, Body> body = base_from_body(angles);
  const Eigen::Quaterniond body_from_base = body.rotation.conjugate();
  Jacobian j(6, size());
  Transform<Link, Link> at;
  for (int i = 0; i < size(); ++i) {
    const Vector3d axis = at.rotation * Vector3d::UnitZ();
    const Vector3d arm = body.translation - at.translation;
    j.col(i) << body_from_base * axis.cross(arm), body_from_base * axis;
    at = at * link(i, angles[i]);
  }
  return j;
}

}  // namespace gannet::vehicle
