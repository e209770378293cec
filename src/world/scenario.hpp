// Scenario: what happens in a simulated world and what must come of it, read from TOML. Positions
// are in Σ_H as it stands when the vehicle is at its reference place (the world's origin, level);
// millimetres and degrees, because people type them. Start-up only.
#pragma once

#include <string>
#include <vector>

#include "platform/base/describe.hpp"
#include "platform/base/result.hpp"
#include "src/core/stereo_rig.hpp"
#include "src/world/action.hpp"
#include "src/world/agv_plant.hpp"
#include "src/world/arm_plant.hpp"
#include "src/world/check.hpp"
#include "src/world/motion.hpp"
#include "src/world/rov_plant.hpp"
#include "src/world/sensor.hpp"

namespace gannet::world {

struct PortConfig {
  double thickness_mm = 0;  // 0: no port
  double distance_mm = 30;
  std::vector<double> tilt_deg = {0, 0};  // of its normal, about x and y
};

struct CameraConfig {
  int width = 640;
  int height = 480;
  double focal_px = 640;
  double baseline_mm = 120;
  double fps = 30;
  double latency_ms = 40;
  std::string looks = "forward";                  // forward | down
  std::vector<double> position_mm = {200, 0, 0};  // of Σ_H in the body's frame
  PortConfig port;                                // before each of them
};

struct VehicleScenario {
  std::string kind = "rov";  // rov | agv | arm | none
  std::vector<double> start_mm = {0, 0, 0};
  std::vector<double> start_turn_deg = {0, 0, 0};
  std::vector<double> current_mm_s = {0, 0, 0};
  std::string drives = "dronecan_esc";  // drive.kind of its motors
  double drive_delay_ms = 5;
  int estop_contacts = 1;
  RovPlantConfig plant;  // of a rov
  AgvPlantConfig agv;    // of an agv
  ArmPlantConfig arm;    // of an arm
};

struct TargetScenario {
  std::string name = "crab";
  std::string texture = "crab";
  std::vector<double> size_mm = {175, 140};
  std::vector<double> position_mm = {0, 0, 500};
  std::vector<double> turn_deg = {0, 0, 0};
  bool known = true;  // a model of it is built for the daemon
  MotionConfig motion;
};

struct SceneScenario {
  std::string water = "pool";  // air | pool | coastal | turbid
  double light_lux = 400;
  double caustics = 0;
  int snow = 0;  // particles in 8 m³
  double background_mm = 1500;
  double floor_mm = 0;          // below the reference hand; 0: none
  std::string detail = "full";  // full | plain
  SensorConfig sensor;
};

struct DaemonScenario {
  double servo_hz = 200;
  std::vector<std::string> settings;  // "room.key=value", as gannetd --set takes them
};

struct Event {
  double at_s = 0;
  std::string text;
  Action action;  // by load_scenario
};

struct Scenario {
  std::string name;
  std::string description;
  double duration_s = 20;
  int seed = 1;
  std::vector<std::string> checks_text;
  CameraConfig camera;
  VehicleScenario vehicle;
  SceneScenario scene;
  DaemonScenario daemon;
  std::vector<TargetScenario> targets;
  std::vector<Event> events;  // in order of time
  std::vector<Check> checks;  // by load_scenario

  StereoRig rig() const;  // with body_from_hand
  Transform<World, Hand> world_from_reference() const;
  Transform<World, Body> start_pose() const;
};

void describe(Visitor& v, PortConfig& c);
void describe(Visitor& v, CameraConfig& c);
void describe(Visitor& v, VehicleScenario& c);
void describe(Visitor& v, TargetScenario& c);
void describe(Visitor& v, SceneScenario& c);
void describe(Visitor& v, DaemonScenario& c);
void describe(Visitor& v, Event& c);
void describe(Visitor& v, Scenario& c);

// Error: all problems, each with file:line where there is one.
Result<Scenario> load_scenario(const std::string& path);

// The file of a name without a slash or ".toml": in $GANNET_SCENARIOS, tests/scenarios below the
// current folder, or the installed ones; anything else is a path as it stands.
std::string find_scenario(const std::string& name, const std::string& program);

}  // namespace gannet::world
