#include "src/world/run_files.hpp"

#include <stdlib.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <utility>

#include "platform/linux/fd.hpp"
#include "platform/linux/whole_file.hpp"
#include "src/config/printer.hpp"
#include "src/config/rig_file.hpp"
#include "src/config/toml_reader.hpp"
#include "src/config/value_text.hpp"
#include "src/world/esc_node.hpp"

namespace gannet::world {
namespace {

constexpr double kWheelMotor_rad_s = 300;  // of an AGV's
constexpr double kFullSpeed_rad_s = 370;   // of the thruster at full throttle

// What a person would enter for this vehicle: the published figures of body and thrusters.
vehicle::RovConfig rov_config(const RovPlantConfig& plant) {
  vehicle::RovConfig rov;
  rov.frame = plant.thrusters.empty() ? "vectored_6dof" : "custom";
  for (const ThrusterPlace& place : plant.thrusters)
    rov.thrusters.push_back({place.position_m, place.direction, rov.curve});
  rov.mass_kg = plant.mass_kg;
  rov.inertia_kg_m2 = plant.inertia_kg_m2;
  rov.added_mass = plant.added_mass;
  rov.linear_drag = plant.linear_drag;
  rov.quadratic_drag = plant.quadratic_drag;
  rov.net_buoyancy_n = (plant.water_density_kg_m3 * plant.volume_m3 - plant.mass_kg) * 9.81;
  rov.thruster_lag_s = kThrusterLag_s;
  return rov;
}

// The same of an AGV: its wheels as its maker says they are.
void configure_agv(const VehicleScenario& vehicle, config::DaemonConfig& c) {
  c.vehicle.agv.wheel_radius_m = vehicle.agv.wheel_radius_m;
  c.vehicle.agv.track_m = vehicle.agv.track_m;
  c.vehicle.agv.gear_ratio = vehicle.agv.gear_ratio;
  c.servo.law = "follow_person";
  c.servo.params.goal_z_m = 4;
  c.drive.kind = vehicle.drives;
  c.drive.vesc.mode = "speed";
  c.drive.cia402.report_position = true;
  for (int i = 0; i < 2; ++i)
    c.drive.motors.push_back(
        {.index = i, .node_id = 20 + i, .full_speed_rad_s = kWheelMotor_rad_s});
}

// A PA-10 as its owner would enter it, on drives that follow each target at once.
void configure_arm(config::DaemonConfig& c) {
  constexpr double kDegree = 3.14159265358979323846 / 180;
  vehicle::ArmConfig& arm = c.vehicle.arm;
  arm.robot = "custom";
  arm.joints = vehicle::pa10_joints();
  c.drive.kind = "cia402";
  c.drive.cia402.mode = "cyclic_velocity";
  c.drive.cia402.velocity_unit = "milli_rpm";
  c.drive.cia402.increments_per_rev = 8192;
  c.drive.cia402.report_position = true;
  for (vehicle::JointConfig& joint : arm.joints) {
    const int i = static_cast<int>(c.drive.motors.size());
    joint.gear_ratio = kArmGear;
    c.drive.motors.push_back({.index = i,
                              .node_id = 20 + i,
                              .full_speed_rad_s = joint.max_speed_deg_s * kDegree * kArmGear});
  }
  c.servo.params.control_roll = c.servo.params.control_pitch = true;
}

}  // namespace

Result<RunFiles> RunFiles::create(const std::string& folder) {
  if (!folder.empty()) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) return Error{folder + ": " + error.message()};
    return RunFiles(std::filesystem::absolute(folder).string(), false);
  }
  std::error_code error;
  std::string name = std::filesystem::temp_directory_path(error).string() + "/gannet-world-XXXXXX";
  if (mkdtemp(name.data()) == nullptr) return linux_os::system_error(name, errno);
  return RunFiles(name, true);
}

RunFiles::RunFiles(RunFiles&& other) noexcept
    : folder_(std::move(other.folder_)), temporary_(std::exchange(other.temporary_, false)) {}

RunFiles::~RunFiles() {
  std::error_code ignored;
  if (temporary_) std::filesystem::remove_all(folder_, ignored);
}

config::DaemonConfig daemon_config(const Scenario& scenario, const RunFiles& files,
                                   const std::vector<std::string>& models, bool stepped) {
  config::DaemonConfig c;
  c.rig = files.rig();
  c.models = models;
  c.realtime.servo_rate_hz = scenario.daemon.servo_hz;
  c.realtime.lock_memory = !stepped;
  c.clock.kind = stepped ? "stepped" : "live";
  c.clock.step_socket = files.step();
  c.camera.kind = "simulated";
  c.camera.simulated.name = files.frames();
  c.can.kind = "local";
  c.can.path = files.bus();
  c.control.socket = files.control();
  c.vehicle.kind = scenario.vehicle.kind;
  if (scenario.vehicle.kind == "agv") configure_agv(scenario.vehicle, c);
  if (scenario.vehicle.kind == "arm") configure_arm(c);
  if (scenario.vehicle.kind == "rov") {
    c.vehicle.rov = rov_config(scenario.vehicle.plant);
    c.drive.kind = scenario.vehicle.drives;
    c.drive.dronecan.esc_timeout_s = EscBehaviour{}.command_timeout_s;
    const bool by_speed = c.drive.kind == "cia402" || c.drive.kind == "odrive";
    if (by_speed) {  // and not a throttle: thrust goes with its square
      c.vehicle.rov.curve.dead_band = 0;
      c.vehicle.rov.curve.exponent = 2;
    }
    const std::size_t thrusters = static_cast<std::size_t>(make_plant(scenario.vehicle)->motors());
    for (int i = 0; i < static_cast<int>(thrusters); ++i)
      c.drive.motors.push_back(
          {.index = i, .node_id = 20 + i, .full_speed_rad_s = kFullSpeed_rad_s});
  }
  return c;
}

Result<void> write_files(const Scenario& scenario, const RunFiles& files,
                         const config::DaemonConfig& config) {
  const auto rig = linux_os::write_file(files.rig(), config::rig_text(scenario.rig()));
  if (!rig) return rig.error();
  return linux_os::write_file(files.config(), config::commented_file(config));
}

Result<void> write_settings(const Scenario& scenario, const RunFiles& files) {
  std::string text;
  for (const std::string& setting : scenario.daemon.settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos) return Error{"'" + setting + "' is not room.key=value"};
    // As --set takes it: a bare word stands for a string.
    const std::string value = setting.substr(equals + 1);
    const bool is_toml = static_cast<bool>(config::parse_toml("x = " + value, setting));
    text +=
        setting.substr(0, equals) + " = " + (is_toml ? value : config::toml_string(value)) + "\n";
  }
  std::error_code error;
  const std::string folder = files.config() + ".d";
  std::filesystem::create_directories(folder, error);
  if (error) return Error{folder + ": " + error.message()};
  return linux_os::write_file(folder + "/scenario.toml", text);
}

}  // namespace gannet::world
