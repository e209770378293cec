// Deeds: what actions do to the simulated world: vehicle, water, cameras, bus and lines. Commands
// of the operator change only what the world itself wants to know of them. World's thread alone.
#pragma once

#include <Eigen/Core>

#include "platform/base/result.hpp"
#include "src/world/cameras.hpp"
#include "src/world/line_end.hpp"
#include "src/world/motors.hpp"
#include "src/world/plant.hpp"
#include "src/world/scenario.hpp"
#include "src/world/stage.hpp"

namespace gannet::world {

// What the scenario's people want and do.
struct Intent {
  int target = 0;
  Eigen::Vector3d goal_m = {0, 0, 0.5};
  bool estop = false;  // pressed, or cut
};

// The parts of a world; borrowed.
struct Parts {
  const Scenario& scenario;
  Stage& stage;
  Plant& plant;
  Cameras& cameras;
  Motors* motors;  // null: no vehicle
  LineEnd& lines;
  Intent& intent;
};

// Error: it could not be done, as when there is no right to switch an interface.
Result<void> act(const Action& action, TimePoint now, Parts& parts);

// Error: the events that these cameras cannot play.
Result<void> check_events(const Scenario& scenario, const FrameSinkAbilities& cameras);

}  // namespace gannet::world
