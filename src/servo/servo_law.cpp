// The list of servo laws.
#include "src/servo/servo_law.hpp"

#include "src/servo/follow_person.hpp"
#include "src/servo/pose_regulation.hpp"

namespace gannet::servo {

Result<std::unique_ptr<ServoLaw>> create_servo_law(const ServoConfig& config,
                                                   const StereoRig& rig) {
  if (!rig.body_from_hand) {
    return Error{"rig: [body_from_hand] is missing: it says how the cameras sit in the vehicle"};
  }
  if (config.law == "pose_regulation") {
    return std::unique_ptr<ServoLaw>(
        std::make_unique<PoseRegulation>(config.params, rig.hand_from_left, *rig.body_from_hand));
  }
  if (config.law == "follow_person") {
    return std::unique_ptr<ServoLaw>(
        std::make_unique<FollowPerson>(config.params, rig.hand_from_left, *rig.body_from_hand));
  }
  return Error{"servo.law: unknown law '" + config.law +
               "'; known: pose_regulation, follow_person"};
}

}  // namespace gannet::servo
