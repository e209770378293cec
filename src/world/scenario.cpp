#include "src/world/scenario.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>

#include "src/config/loader.hpp"
#include "src/config/toml_reader.hpp"

namespace gannet::world {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

Eigen::Vector3d metres(const std::vector<double>& mm) {
  return Eigen::Vector3d(mm[0], mm[1], mm[2]) / 1000;
}

Eigen::Quaterniond turn(const std::vector<double>& deg) {
  return quaternion_from_rpy(deg[0] * kDegree, deg[1] * kDegree, deg[2] * kDegree);
}

// Σ_H's axes (x right, y down, z ahead) in the body's (x forward, y left, z up).
Eigen::Quaterniond body_from_hand_rotation(const std::string& looks) {
  Eigen::Matrix3d forward;
  forward << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Eigen::Matrix3d down;  // the image's top is ahead
  down << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  return Eigen::Quaterniond(looks == "down" ? down : forward);
}

void check_references(const Scenario& s, const config::Origin& where, config::Problems& problems) {
  for (const Event& event : s.events) {
    const bool names_target = event.action.verb == Verb::kTarget ||
                              event.action.verb == Verb::kOcclude ||
                              event.action.verb == Verb::kUncover;
    const bool known = event.action.name == "none" ||
                       std::any_of(s.targets.begin(), s.targets.end(), [&](const auto& target) {
                         return target.name == event.action.name;
                       });
    if (names_target && !known)
      problems.add(where, "'" + event.text + "': there is no target of that name");
    if (event.at_s > s.duration_s)
      problems.add(where, "'" + event.text + "' is after the end of the run (duration_s)");
  }
}

// The texts of events and checks; what they say, not where they stand, is reported.
void parse_texts(Scenario& s, const std::string& path, const config::Origins& origins,
                 config::Problems& problems) {
  for (std::size_t i = 0; i < s.events.size(); ++i) {
    const auto origin = origins.find("event[" + std::to_string(i) + "].do");
    auto action = parse_action(s.events[i].text);
    if (action)
      s.events[i].action = std::move(*action);
    else
      problems.add(origin == origins.end() ? config::Origin{path, 0} : origin->second,
                   action.error().text);
  }
  for (const std::string& text : s.checks_text) {
    const auto origin = origins.find("checks");
    auto check = parse_check(text);
    if (check)
      s.checks.push_back(std::move(*check));
    else
      problems.add(origin == origins.end() ? config::Origin{path, 0} : origin->second,
                   check.error().text);
  }
}

bool exists(const std::string& path) { return access(path.c_str(), R_OK) == 0; }

}  // namespace

StereoRig Scenario::rig() const {
  StereoRig rig;
  rig.left.width = camera.width;
  rig.left.height = camera.height;
  rig.left.fx = rig.left.fy = camera.focal_px;
  rig.left.cx = (camera.width - 1) / 2.0;
  rig.left.cy = (camera.height - 1) / 2.0;
  if (camera.port.thickness_mm > 0) {
    FlatPort& port = rig.left.port.emplace();
    port.normal = turn({camera.port.tilt_deg[0], camera.port.tilt_deg[1], 0}) * port.normal;
    port.distance_m = camera.port.distance_mm / 1000;
    port.thickness_m = camera.port.thickness_mm / 1000;
  }
  rig.right = rig.left;
  rig.right_from_left.translation = {-camera.baseline_mm / 1000, 0, 0};
  rig.hand_from_left.translation = {-camera.baseline_mm / 2000, 0, 0};
  rig.body_from_hand =
      Transform<Body, Hand>{body_from_hand_rotation(camera.looks), metres(camera.position_mm)};
  return rig;
}

Transform<World, Hand> Scenario::world_from_reference() const {
  return Transform<World, Body>::identity() * *rig().body_from_hand;
}

Transform<World, Body> Scenario::start_pose() const {
  const Transform<Hand, Hand> start{turn(vehicle.start_turn_deg), metres(vehicle.start_mm)};
  return world_from_reference() * start * rig().body_from_hand->inverse();
}

Result<Scenario> load_scenario(const std::string& path) {
  auto root = config::read_toml(path);
  if (!root) return root.error();
  Scenario scenario;
  config::Origins origins;
  config::Problems problems;
  config::load(*root, path, scenario, origins, problems);
  parse_texts(scenario, path, origins, problems);
  check_references(scenario, {path, 0}, problems);
  if (!problems.empty()) return problems.error();
  std::stable_sort(scenario.events.begin(), scenario.events.end(),
                   [](const Event& a, const Event& b) { return a.at_s < b.at_s; });
  return scenario;
}

std::string find_scenario(const std::string& name, const std::string& program) {
  if (name.find('/') != std::string::npos || name.ends_with(".toml")) return name;
  std::vector<std::string> folders = {"tests/scenarios"};
  if (const char* asked = std::getenv("GANNET_SCENARIOS")) folders.insert(folders.begin(), asked);
  const std::string bin = program.substr(0, program.rfind('/') + 1);
  folders.push_back(bin + "../share/gannet/scenarios");
  for (const std::string& folder : folders)
    if (exists(folder + "/" + name + ".toml")) return folder + "/" + name + ".toml";
  return name + ".toml";
}

void describe(Visitor& v, PortConfig& c) {
  v.field("thickness_mm", c.thickness_mm,
          {.min = 0, .max = 100, .unit = "mm", .help = "Of its glass; 0: there is no port."});
  v.field("distance_mm", c.distance_mm,
          {.min = 0, .max = 500, .unit = "mm", .help = "From a camera's centre to the glass."});
  v.field("tilt_deg", c.tilt_deg,
          {.min = -20, .max = 20, .size = 2, .unit = "deg", .help = "About the axes x and y."});
}

void describe(Visitor& v, CameraConfig& c) {
  v.field("width", c.width, {.min = 16, .max = 4096, .unit = "px", .help = "Of each image."});
  v.field("height", c.height, {.min = 16, .max = 4096, .unit = "px", .help = "Of each image."});
  v.field("focal_px", c.focal_px, {.min = 10, .max = 1e4, .unit = "px", .help = "Focal length."});
  v.field("baseline_mm", c.baseline_mm,
          {.min = 1, .max = 1000, .unit = "mm", .help = "Between the cameras."});
  v.field("fps", c.fps, {.min = 1, .max = 240, .unit = "1/s", .help = "Pairs a second."});
  v.field("latency_ms", c.latency_ms,
          {.min = 0, .max = 1000, .unit = "ms", .help = "From exposure to the daemon."});
  v.field("looks", c.looks, {.choices = {"forward", "down"}, .help = "Where the cameras look."});
  v.field("position_mm", c.position_mm,
          {.size = 3, .unit = "mm", .help = "Of the hand frame, in the body's axes."});
  v.group("port", c.port, "The flat port of the housing before each camera.");
}

void describe(Visitor& v, VehicleScenario& c) {
  v.field("kind", c.kind,
          {.choices = {"rov", "agv", "arm", "none"}, .help = "What carries the cameras."});
  v.field("start_mm", c.start_mm,
          {.size = 3, .unit = "mm", .help = "Where the hand frame starts."});
  v.field("start_turn_deg", c.start_turn_deg,
          {.size = 3, .unit = "°", .help = "How it is turned then: R = Rz·Ry·Rx."});
  v.field("current_mm_s", c.current_mm_s,
          {.size = 3, .unit = "mm/s", .help = "Of the water at the start."});
  v.field("drives", c.drives,
          {.choices = {"dronecan_esc", "cia402", "vesc", "odrive"},
           .help = "What its motors speak: drive.kind of the daemon."});
  v.field("drive_delay_ms", c.drive_delay_ms,
          {.min = 0, .max = 1000, .unit = "ms", .help = "From a frame on the bus to the motor."});
  v.field("estop_contacts", c.estop_contacts,
          {.min = 1, .max = 2, .help = "Of the e-stop button; two move in opposite ways."});
  v.group("plant", c.plant, "A rov's body and water, BlueROV2 Heavy unless said otherwise.");
  v.group("agv", c.agv, "An agv's body, wheels and floor.");
  v.group("arm", c.arm, "An arm's joints: a Mitsubishi PA-10.");
}

void describe(Visitor& v, TargetScenario& c) {
  v.field("name", c.name, {.help = "As events and the daemon know it."});
  v.field("texture", c.texture, {.help = "Its photograph, one of the world's textures."});
  v.field("size_mm", c.size_mm,
          {.min = 5, .max = 5000, .size = 2, .unit = "mm", .help = "Width and height."});
  v.field("position_mm", c.position_mm,
          {.size = 3, .unit = "mm", .help = "Resting place of its middle."});
  v.field("turn_deg", c.turn_deg,
          {.size = 3, .unit = "°", .help = "How it is turned there: R = Rz·Ry·Rx."});
  v.field("known", c.known, {.help = "Whether the daemon gets a model of it."});
  v.group("motion", c.motion, "How it moves.");
}

void describe(Visitor& v, SceneScenario& c) {
  v.field("water", c.water,
          {.choices = {"air", "pool", "coastal", "turbid"}, .help = "Between eye and target."});
  v.field("light_lux", c.light_lux,
          {.min = 0.1, .max = 1e5, .unit = "lx", .help = "Little light is noise."});
  v.field("caustics", c.caustics,
          {.min = 0, .max = 1, .help = "Nets of sunlight that waves make: 0 none, 1 strong."});
  v.field("snow", c.snow,
          {.min = 0, .max = 5000, .unit = "particles in 8 m³", .help = "Marine snow."});
  v.field("background_mm", c.background_mm,
          {.min = 100,
           .max = 1e5,
           .unit = "mm",
           .help = "How far from the reference hand the textured ground is, along its view."});
  v.field("floor_mm", c.floor_mm,
          {.min = 0,
           .max = 1e5,
           .unit = "mm",
           .help = "How far below the reference hand a textured floor is, which goes on to the "
                   "horizon; 0: there is none."});
  v.field("detail", c.detail,
          {.choices = {"full", "plain"},
           .help = "plain: no ground, no blur, no noise, a fifth of the work; for emulated "
                   "machines."});
  v.group("sensor", c.sensor, "The cameras' sensors.");
}

void describe(Visitor& v, DaemonScenario& c) {
  v.field("servo_hz", c.servo_hz,
          {.min = 10, .max = 1000, .unit = "1/s", .help = "Rate of the servo loop and of steps."});
  v.field("settings", c.settings, {.help = "Its config, each as 'room.key = value'."});
}

void describe(Visitor& v, Event& c) {
  v.field("at_s", c.at_s, {.min = 0, .unit = "s", .help = "When."});
  v.field("do", c.text, {.help = "What: press estop, arm, target NAME …"});
}

void describe(Visitor& v, Scenario& c) {
  v.field("name", c.name, {.help = "As the table says it."});
  v.field("description", c.description, {.help = "What is shown, in a sentence."});
  v.field("duration_s", c.duration_s,
          {.min = 0.1, .max = 3600, .unit = "s", .help = "Length of the run."});
  v.field("seed", c.seed, {.min = 0, .help = "Of noise and random motion."});
  v.field("checks", c.checks_text, {.help = "What must hold: 'settle_s < 6' …"});
  v.group("camera", c.camera, "The two cameras.");
  v.group("vehicle", c.vehicle, "What moves, and from where.");
  v.group("scene", c.scene, "Water, light and ground.");
  v.group("daemon", c.daemon, "How the daemon is set.");
  v.list("target", c.targets, "A flat photograph in the water each.");
  v.list("event", c.events, "Something that happens at a time each.");
}

}  // namespace gannet::world
