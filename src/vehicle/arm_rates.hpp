// From a wished twist of an arm's hand to speeds of its joints.
//  - Damped least squares direction by direction: along a singular vector with singular value σ
//    the inverse is σ / (σ² + λ²), λ² = (1 − σ²/ε²)·λ₀² where σ < ε and 0 elsewhere, so that what
//    can be done is done exactly (A. A. Maciejewski, C. A. Klein, "Numerical filtering for the
//    operation of robotic manipulators through kinematically singular configurations", J. Robotic
//    Systems 5(6), 1988; S. Chiaverini, IEEE Trans. Robotics and Automation 13(3), 1997, Eq. 14).
//  - What the twist leaves free goes to the posture, by the projector 1 − J⁺J (A. Liégeois, IEEE
//    Trans. SMC 7(12), 1977).
//  - A joint that would pass its bounds is set on the bound, and the others make up for it as far
//    as they can (F. Flacco, A. De Luca, O. Khatib, "Motion control of redundant robots under
//    joint constraints: saturation in the null space", ICRA 2012).
// Pure; RT safe.
#pragma once

#include "src/vehicle/arm_chain.hpp"

namespace gannet::vehicle {

struct Damping {
  double radian_as_m = 0.3;  // weighs turns against ways
  double singular_below = 0.06;
  double most = 0.05;
};

struct JointBounds {
  Joints least, most;  // rad/s
};

Joints joint_rates(const Jacobian& jacobian, const Vector6d& twist, const Joints& posture,
                   const JointBounds& bounds, const Damping& damping);

// Least singular value of the Jacobian with its turns weighed.
double least_singular_value(const Jacobian& jacobian, const Damping& damping);

}  // namespace gannet::vehicle
