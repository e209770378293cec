// Goal: where the target shall be, seen from the hand frame Σ_H (optical axes: x right, y down,
// z forward). Metres. A value; RT safe.
#pragma once

#include "src/core/transform.hpp"

namespace gannet::servo {

struct Goal {
  Transform<Hand, Target> hand_from_target = {Eigen::Quaterniond::Identity(), {0, 0, 0.5}};
};

}  // namespace gannet::servo
