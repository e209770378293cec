// The list of plants.
#include "src/world/agv_plant.hpp"
#include "src/world/arm_plant.hpp"
#include "src/world/plant.hpp"
#include "src/world/rov_plant.hpp"
#include "src/world/scenario.hpp"
#include "src/world/thruster.hpp"

namespace gannet::world {

double speed_told(double throttle) { return steady_speed_rad_s(throttle); }

std::unique_ptr<Plant> make_plant(const VehicleScenario& vehicle) {
  if (vehicle.kind == "arm") return std::make_unique<ArmPlant>(vehicle.arm);
  if (vehicle.kind == "agv") return std::make_unique<AgvPlant>(vehicle.agv);
  return std::make_unique<RovPlant>(vehicle.plant);
}

}  // namespace gannet::world
