#include "hal/drive/drive_config.hpp"

namespace gannet::hal {

void describe(Visitor& v, MotorConfig& c) {
  v.field("index", c.index,
          {.min = 0, .max = 19, .help = "The ESC's index on the bus, as set in the ESC."});
  v.field("node_id", c.node_id,
          {.min = 1,
           .max = 127,
           .help = "The static node id of the ESC, or of the node that the PWM ESC hangs on."});
  v.field("reversed", c.reversed,
          {.help = "True where the motor turns the other way than the vehicle's sign."});
  v.field("max_command", c.max_command,
          {.min = 0.01, .max = 1, .help = "The part of the ESC's range that full thrust uses."});
  v.field("pole_pairs", c.pole_pairs,
          {.min = 1,
           .max = 50,
           .help = "Divides the reported speed. 1 where the ESC reports the shaft's, as DroneCAN "
                   "wants; the motor's pole pairs where it reports the electrical one."});
  v.field("has_feedback", c.has_feedback,
          {.help = "False for an ESC that reports no status: then its node's heartbeat must do."});
  v.field("full_speed_rad_s", c.full_speed_rad_s,
          {.min = 0.1,
           .max = 10000,
           .unit = "rad/s",
           .help = "For drives that are commanded a speed: that of the shaft at full command."});
}

void describe(Visitor& v, DriveConfig& c) {
  v.field("kind", c.kind,
          {.choices = {"dronecan_esc", "cia402", "vesc", "odrive"},
           .help = "The protocol that the motors speak."});
  v.field("own_node_id", c.own_node_id,
          {.min = 1, .max = 126, .help = "Our static node id; nobody else's on that bus."});
  v.field("range", c.range,
          {.choices = {"reversible", "forward_only", "pwm_centred"},
           .help = "What the ESCs make of a command. reversible: -8191 to 8191, 0 stops; "
                   "forward_only: 0 to 8191, 0 stops; pwm_centred: a node that turns 0 to 8191 "
                   "into the whole pulse range of a reversible PWM ESC, so that 4096 stops."});
  v.field("command_period_s", c.command_period_s,
          {.min = 0,
           .max = 0.2,
           .unit = "s",
           .help = "Least time between two commands of dronecan_esc and vesc; 0: one in each servo "
                   "cycle. Stop and start are sent at once in any case, and stops of vesc in each "
                   "cycle."});
  v.field("feedback_timeout_s", c.feedback_timeout_s,
          {.min = 0.02, .max = 10, .unit = "s", .help = "A motor silent for longer is not alive."});
  v.field("node_timeout_s", c.node_timeout_s,
          {.min = 1,
           .max = 10,
           .unit = "s",
           .help = "A node without a heartbeat for longer is offline; DroneCAN says 3."});
  v.field("arming_status", c.arming_status,
          {.help = "Broadcasts whether the motors are enabled; some ESCs turn nothing without."});
  v.group("dronecan", c.dronecan, "DroneCAN ESCs (drive.kind = dronecan_esc).");
  v.group("cia402", c.cia402, "CiA 402 drives over CANopen (drive.kind = cia402).");
  v.group("vesc", c.vesc, "VESC controllers (drive.kind = vesc).");
  v.group("odrive", c.odrive, "ODrive controllers over CANSimple (drive.kind = odrive).");
  v.list("motor", c.motors, "One table for each motor, in the order of the vehicle's thrusters.");
}

}  // namespace gannet::hal
