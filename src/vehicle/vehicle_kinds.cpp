// The list of vehicles.
#include "src/vehicle/agv.hpp"
#include "src/vehicle/arm.hpp"
#include "src/vehicle/rov.hpp"
#include "src/vehicle/vehicle.hpp"

namespace gannet::vehicle {
namespace {

// Poses only: no motors, so there is nothing to arm.
class NoVehicle final : public Vehicle {
 public:
  int motors() const override { return 0; }
  Reach update(const MotionWish&, Permit, Duration, std::span<hal::DriveSetpoint>) override {
    return {};
  }
  Twist<Body> own_velocity() const override { return {}; }
  void reset() override {}
};

}  // namespace

Result<std::unique_ptr<Vehicle>> create_vehicle(const VehicleConfig& config) {
  if (config.kind == "none") return std::unique_ptr<Vehicle>(std::make_unique<NoVehicle>());
  if (config.kind == "rov") return Rov::create(config.rov);
  if (config.kind == "agv") return Agv::create(config.agv);
  if (config.kind == "arm") return Arm::create(config.arm);
  return Error{"vehicle.kind: unknown kind '" + config.kind + "'; known: none, rov, agv, arm"};
}

}  // namespace gannet::vehicle
