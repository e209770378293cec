#include "hal/drive/cia402_config.hpp"

#include <numbers>

namespace gannet::hal {

void describe(Visitor& v, Cia402Config& c) {
  v.field(
      "mode", c.mode,
      {.choices = {"profile_velocity", "cyclic_velocity"},
       .help = "profile_velocity: the drive ramps to each target by its own profile; "
               "cyclic_velocity (cyclic synchronous velocity): it follows each target at once."});
  v.field("pdo", c.pdo,
          {.min = 1,
           .max = 4,
           .help = "The receive and transmit PDO to use; another than 1 for drives whose PDOs "
                   "are fixed."});
  v.field("velocity_unit", c.velocity_unit,
          {.choices = {"rpm", "tenth_rpm", "milli_rpm", "increments_per_s"},
           .help = "The unit of objects 60FF and 606C, as the drive's manual says or as it was "
                   "set in the drive. Wrong here is wrong by orders of magnitude."});
  v.field("increments_per_rev", c.increments_per_rev,
          {.min = 1,
           .max = 1e9,
           .help = "For increments_per_s and report_position: encoder increments, all edges "
                   "counted, of one turn of the motor."});
  v.field("gear_ratio", c.gear_ratio,
          {.min = 0.001, .max = 1000, .help = "Turns of the motor for one of the driven shaft."});
  v.field("acceleration_rad_s2", c.acceleration_rad_s2,
          {.min = 0,
           .max = 1e6,
           .unit = "rad/s^2",
           .help = "Written to the profile's acceleration and deceleration (6083, 6084), as "
                   "velocity_unit per second; 0: as stored in the drive."});
  v.field("quick_stop_rad_s2", c.quick_stop_rad_s2,
          {.min = 0,
           .max = 1e6,
           .unit = "rad/s^2",
           .help = "Written to the quick stop's deceleration (6085), as velocity_unit per second; "
                   "0: as stored in the drive."});
  v.field("report_current", c.report_current,
          {.help = "Maps the motor's current (6078) too; false for a drive that has none."});
  v.field("report_position", c.report_position,
          {.help = "Maps the position (6064, in encoder increments) to the next transmit PDO after "
                   "pdo; an arm needs it."});
  v.field(
      "stop", c.stop,
      {.choices = {"quick_stop", "disable_voltage"},
       .help = "How a motor that is no longer enabled stops: by the drive's quick stop ramp, or "
               "by coasting."});
  v.field("stop_time_s", c.stop_time_s,
          {.min = 0,
           .max = 30,
           .unit = "s",
           .help = "A quick stop that takes longer ends with the voltage taken away."});
  v.field("heartbeat_period_s", c.heartbeat_period_s,
          {.min = 0.005, .max = 1, .unit = "s", .help = "Time between two of our heartbeats."});
  v.field("guard_time_s", c.guard_time_s,
          {.min = 0.01,
           .max = 10,
           .unit = "s",
           .help = "A drive that misses our heartbeat for so long stops by itself (1016); at least "
                   "twice heartbeat_period_s."});
  v.field("guard_reaction", c.guard_reaction,
          {.choices = {"quick_stop", "disable_voltage", "fault"},
           .help = "What it then does (6007): quick stop, coast, or its fault reaction."});
  v.field("accept_unguarded", c.accept_unguarded,
          {.help = "True lets drives be armed that do not stop by themselves when the daemon dies. "
                   "Then something else must cut their power."});
  v.field("node_heartbeat_s", c.node_heartbeat_s,
          {.min = 0.01,
           .max = 10,
           .unit = "s",
           .help = "Time between two heartbeats of a drive, written to it (1017)."});
  v.field("node_timeout_s", c.node_timeout_s,
          {.min = 0.02,
           .max = 60,
           .unit = "s",
           .help = "A drive without a heartbeat for longer is lost; at least twice "
                   "node_heartbeat_s."});
  v.field("sdo_timeout_s", c.sdo_timeout_s,
          {.min = 0.005,
           .max = 5,
           .unit = "s",
           .help = "An SDO request unanswered for longer is repeated, twice."});
}

double velocity_units_per_rad_s(const Cia402Config& config) {
  double per_rev_s = 0;
  if (config.velocity_unit == "rpm") per_rev_s = 60;
  if (config.velocity_unit == "tenth_rpm") per_rev_s = 600;
  if (config.velocity_unit == "milli_rpm") per_rev_s = 60000;
  if (config.velocity_unit == "increments_per_s") per_rev_s = config.increments_per_rev;
  return per_rev_s / (2 * std::numbers::pi) * config.gear_ratio;
}

double position_units_per_rad(const Cia402Config& config) {
  return config.increments_per_rev / (2 * std::numbers::pi) * config.gear_ratio;
}

}  // namespace gannet::hal
