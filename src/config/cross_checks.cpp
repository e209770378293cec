#include "src/config/cross_checks.hpp"

#include <algorithm>
#include <set>

#include "src/config/rig_file.hpp"
#include "src/config/value_text.hpp"

namespace gannet::config {
namespace {

class Checker {
 public:
  Checker(LoadedConfig& loaded, const std::string& file, Problems& problems)
      : loaded_(loaded), config_(loaded.config), file_(file), problems_(problems) {}

  void run() {
    check_rig();
    check_cores();
    check_clock_and_frames();
    check_track();
    check_vehicle();
    check_arm();
    check_agv();
    check_drive();
    check_estop();
    check_kernel_times();
  }

 private:
  Origin where(std::string key) const {
    while (!key.empty()) {
      const auto found = loaded_.origins.find(key);
      if (found != loaded_.origins.end()) return found->second;
      const std::size_t dot = key.rfind('.');
      key.resize(dot == std::string::npos ? 0 : dot);
    }
    return {file_.empty() ? "gannetd" : file_, 0};
  }

  void refuse(const std::string& key, const std::string& text) {
    problems_.add(where(key), key + ": " + text);
  }

  void check_rig() {
    if (config_.rig.empty())
      return refuse("rig", "is not set; it is the path of the cameras' calibration");
    Result<StereoRig> rig = load_rig(config_.rig);
    if (!rig) return problems_.add(where("rig"), "rig: " + rig.error().text);
    loaded_.rig = std::move(*rig);
    if (config_.vehicle.kind != "none" && !loaded_.rig.body_from_hand)
      refuse("rig", config_.rig +
                        " has no [body_from_hand], which a vehicle needs: where the "
                        "cameras sit on it");
  }

  void check_core(const std::string& key, int core) {
    if (config_.board.cores > 0 && core >= config_.board.cores)
      refuse(key, "core " + std::to_string(core) + " does not exist; board.cores is " +
                      std::to_string(config_.board.cores));
  }

  void check_cores() {
    check_core("realtime.capture.core", config_.realtime.capture.core);
    check_core("realtime.vision.core", config_.realtime.vision.core);
    check_core("realtime.servo.core", config_.realtime.servo.core);
    for (const int core : config_.realtime.worker_cores) check_core("realtime.worker_cores", core);
  }

  void check_clock_and_frames() {
    if (config_.camera.kind == "replay" && config_.camera.replay.directory.empty())
      refuse("camera.replay.directory", "is needed by camera.kind \"replay\"");
    check_v4l2();
    if (config_.clock.kind == "stepped" && config_.clock.step_socket.empty())
      refuse("clock.step_socket", "is needed by clock.kind \"stepped\"");
    if (config_.frames.kind == "directory" && config_.frames.directory.empty())
      refuse("frames.directory", "is needed by frames.kind \"directory\"");
  }

  void check_v4l2() {
    const std::string& kind = config_.camera.kind;
    const auto& pair = config_.camera.v4l2_pair;
    const auto need = [&](const char* key, const std::string& value) {
      if (value.empty())
        refuse("camera." + kind + "." + key, "is needed by camera.kind \"" + kind + "\"");
    };
    if (kind == "v4l2_side_by_side") need("device", config_.camera.v4l2_side_by_side.device);
    if (kind == "v4l2_pair") {
      need("left", pair.left);
      need("right", pair.right);
      if (pair.stream.rate_hz * pair.pair_tolerance_s >= 0.5)
        refuse("camera.v4l2_pair.pair_tolerance_s",
               "is not less than half a period, " + number_text(0.5 / pair.stream.rate_hz) + " s");
    }
  }

  void check_track() {
    if (config_.track.z_min_m >= config_.track.z_max_m)
      refuse("track.z_max_m",
             "is not beyond track.z_min_m, " + number_text(config_.track.z_min_m) + " m");
    const auto& de = config_.track.search.differential_evolution;
    if (de.scale_min > de.scale_max)
      refuse("track.search.differential_evolution.scale_max", "is below scale_min");
  }

  int thrusters() const {
    const vehicle::RovConfig& rov = config_.vehicle.rov;
    if (rov.frame == "custom") return static_cast<int>(rov.thrusters.size());
    return rov.frame == "vectored" ? 6 : 8;
  }

  void check_agv() {
    if (config_.vehicle.kind != "agv") return;
    const std::size_t motors = config_.drive.motors.size();
    if (motors != 2)
      refuse("drive.motor", std::to_string(motors) +
                                " motors for 2 wheels; each needs one table [[drive.motor]], the "
                                "left wheel's first");
    if (config_.drive.kind == "dronecan_esc")
      refuse("drive.kind",
             "\"dronecan_esc\" commands a throttle; an AGV's wheels need a speed: "
             "cia402, vesc, odrive");
    if (config_.drive.kind == "vesc" && config_.drive.vesc.mode != "speed")
      refuse("drive.vesc.mode", "must be \"speed\" for an AGV");
    const vehicle::AgvConfig& agv = config_.vehicle.agv;
    for (std::size_t i = 0; i < motors; ++i) {
      const hal::MotorConfig& motor = config_.drive.motors[i];
      const double wheel = motor.full_speed_rad_s * motor.max_command / agv.gear_ratio;
      if (wheel < agv.max_wheel_speed_rad_s)
        refuse("vehicle.agv.max_wheel_speed_rad_s", "motor " + std::to_string(i + 1) +
                                                        " turns its wheel by " +
                                                        number_text(wheel) + " rad/s at most");
    }
  }

  void check_arm() {
    if (config_.vehicle.kind != "arm") return;
    const vehicle::ArmConfig& arm = config_.vehicle.arm;
    if (arm.robot == "custom" && arm.joints.empty())
      return refuse("vehicle.arm.robot",
                    "\"custom\" needs a table [[vehicle.arm.joint]] for each one");
    if (arm.robot != "custom" && !arm.joints.empty())
      refuse("vehicle.arm.joint", "is for robot \"custom\" only");
    const std::size_t joints = vehicle::joints_of(arm).size();
    if (config_.drive.motors.size() != joints)
      refuse("drive.motor", std::to_string(config_.drive.motors.size()) + " motors for " +
                                std::to_string(joints) +
                                " joints; each needs one table [[drive.motor]], in their order");
    if (config_.drive.kind != "cia402")
      refuse("drive.kind", "\"" + config_.drive.kind +
                               "\" tells no positions, which an arm needs; \"cia402\" does");
    else if (!config_.drive.cia402.report_position)
      refuse("drive.cia402.report_position", "must be true for an arm");
  }

  void check_vehicle() {
    if (config_.vehicle.kind != "rov") return;
    const vehicle::RovConfig& rov = config_.vehicle.rov;
    if (rov.frame == "custom" && rov.thrusters.empty())
      return refuse("vehicle.rov.frame",
                    "\"custom\" needs a table [[vehicle.rov.thruster]] for each one");
    if (rov.frame != "custom" && !rov.thrusters.empty())
      refuse("vehicle.rov.thruster", "is for frame \"custom\" only");
    const int motors = static_cast<int>(config_.drive.motors.size());
    if (motors != thrusters())
      refuse("drive.motor", std::to_string(motors) + " motors for " + std::to_string(thrusters()) +
                                " thrusters; each needs one table [[drive.motor]], in the order "
                                "of the thrusters");
  }

  // ESCs that time out between two commands would turn in jerks.
  void check_esc_timeout() {
    const hal::DriveConfig& drive = config_.drive;
    if (drive.kind != "dronecan_esc" || !drive.dronecan.is_guarded()) return;
    const double period = std::max(drive.command_period_s, 1 / config_.realtime.servo_rate_hz);
    if (drive.dronecan.esc_timeout_s < 3 * period)
      refuse("drive.dronecan.esc_timeout_s",
             "is shorter than three commands, which come every " + number_text(period) + " s");
  }

  void check_drive() {
    check_esc_timeout();
    const bool has_indices = config_.drive.kind == "dronecan_esc";
    const bool has_own_id = config_.drive.kind != "odrive";
    std::set<int> indices, nodes;
    for (std::size_t i = 0; i < config_.drive.motors.size(); ++i) {
      const hal::MotorConfig& motor = config_.drive.motors[i];
      const std::string key = "drive.motor[" + std::to_string(i) + "]";
      if (has_indices && !indices.insert(motor.index).second)
        refuse(key + ".index", std::to_string(motor.index) + " is used twice");
      // Several PWM ESCs may hang on one DroneCAN node; everywhere else a node has one motor.
      if (!has_indices && !nodes.insert(motor.node_id).second)
        refuse(key + ".node_id", std::to_string(motor.node_id) + " is used twice");
      if (has_own_id && motor.node_id == config_.drive.own_node_id)
        refuse(key + ".node_id", "is drive.own_node_id, the daemon's own");
    }
  }

  // Antivalent: two channels that are wired alike do not show a short between them.
  void check_estop() {
    const GpioConfig& gpio = config_.gpio;
    if (gpio.estop_second.kind == "none") return;
    if (gpio.estop.kind == "none")
      refuse("gpio.estop_second.kind", "a second channel needs a first one, gpio.estop");
    if (gpio.estop.active_low == gpio.estop_second.active_low)
      refuse("gpio.estop_second.active_low",
             "must differ from gpio.estop.active_low: one contact opens, the other one closes");
  }

  // The kernel stamps by its own clock.
  void check_kernel_times() {
    if (config_.clock.kind != "stepped") return;
    if (config_.camera.kind.rfind("v4l2", 0) == 0)
      refuse("camera.kind", "\"" + config_.camera.kind + "\" needs clock.kind \"live\"");
    if (config_.can.kind == "socketcan")
      refuse("can.kind", "\"socketcan\" needs clock.kind \"live\"");
    if (config_.gpio.estop.kind == "gpiod")
      refuse("gpio.estop.kind", "\"gpiod\" needs clock.kind \"live\"");
  }

  LoadedConfig& loaded_;
  const DaemonConfig& config_;
  const std::string& file_;
  Problems& problems_;
};

}  // namespace

void check_together(LoadedConfig& loaded, const std::string& file, Problems& problems) {
  Checker(loaded, file, problems).run();
}

}  // namespace gannet::config
