// ArmPlant: a serial arm whose joints follow the speeds that their drives tell, each with a lag of
// first order, and stop hard at their limits of angle. The kinematics are the vehicle room's own
// (property-tested there against their derivative); ArmPlantConfig can make the real arm's links
// longer or shorter than the daemon knows.
//
// The lag of 30 ms is assumed: the PA-10's maker publishes none.
//
// The hand stands at the world's reference place with the joints at their rest; the foot is where
// that puts it. Any start pose is reached by inverse kinematics from there. Fixed steps of 1 ms.
// World's thread alone.
#pragma once

#include <vector>

#include "platform/base/describe.hpp"
#include "src/vehicle/arm_chain.hpp"
#include "src/world/plant.hpp"

namespace gannet::world {

struct ArmPlantConfig {
  double lag_s = 0.03;
  double length_factor = 1;  // of every link, against what the daemon is told
};

void describe(Visitor& v, ArmPlantConfig& c);

class ArmPlant final : public Plant {
 public:
  explicit ArmPlant(const ArmPlantConfig& config);

  int motors() const override { return static_cast<int>(angles_.size()); }
  void command(std::span<const double> throttles) override;
  void advance(double seconds) override;
  MotorState motor(int index) const override;
  void jam(int index, bool jammed) override { jammed_[static_cast<std::size_t>(index)] = jammed; }

  // As near as the joints can come.
  void set_pose(const Transform<World, Body>& pose) override;
  const Transform<World, Body>& pose() const override { return pose_; }
  Twist<Body> velocity() const override;

  const vehicle::Joints& angles() const { return angles_; }  // rad, for tests

 private:
  void settle();  // pose_ from angles_

  const std::vector<vehicle::JointConfig> joints_;
  const vehicle::ArmChain chain_;
  const double lag_s_;
  Transform<World, vehicle::ArmBase> world_from_base_;
  Transform<World, Body> pose_;
  vehicle::Joints angles_, speeds_, told_;  // of the joints
  std::vector<bool> jammed_;
};

// The shaft that the drives speak of turns so many times for one turn of the joint.
inline constexpr double kArmGear = 50;

}  // namespace gannet::world
