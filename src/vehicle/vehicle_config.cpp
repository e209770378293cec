#include "src/vehicle/vehicle_config.hpp"

namespace gannet::vehicle {

void describe(Visitor& v, CurveConfig& c) {
  v.field("max_forward_n", c.max_forward_n,
          {.min = 0.01, .max = 100000, .unit = "N", .help = "Thrust at command 1."});
  v.field("max_backward_n", c.max_backward_n,
          {.min = 0.01, .max = 100000, .unit = "N", .help = "Thrust at command -1."});
  v.field("dead_band", c.dead_band,
          {.min = 0, .max = 0.9, .help = "Commands up to this fraction make no thrust."});
  v.field("exponent", c.exponent,
          {.min = 0.5, .max = 4, .help = "Thrust grows with this power of the command beyond it."});
  v.field("limit", c.limit, {.min = 0.05, .max = 1, .help = "Largest command that is used, of 1."});
}

void describe(Visitor& v, ThrusterConfig& c) {
  v.field("position_m", c.position_m,
          {.min = -100,
           .max = 100,
           .size = 3,
           .unit = "m",
           .help = "Forward, left, up from the vehicle's centre of mass."});
  v.field("direction", c.direction,
          {.min = -1,
           .max = 1,
           .size = 3,
           .help = "Of the force on the vehicle at positive command; any length but zero."});
  v.group("curve", c.curve, "Command to thrust.");
}

namespace {

void describe_body(Visitor& v, RovConfig& c) {
  v.field("mass_kg", c.mass_kg, {.min = 0.1, .max = 100000, .unit = "kg", .help = "In air."});
  v.field("inertia_kg_m2", c.inertia_kg_m2,
          {.min = 1e-4,
           .max = 1e7,
           .size = 3,
           .unit = "kg·m²",
           .help = "About the forward, left and upward axis."});
  v.field("added_mass", c.added_mass,
          {.min = 0,
           .max = 1e7,
           .size = 6,
           .unit = "kg, kg·m²",
           .help = "Water moved along; x, y, z, roll, pitch, yaw."});
  v.field("linear_drag", c.linear_drag,
          {.min = 0,
           .max = 1e7,
           .size = 6,
           .unit = "N/(m/s), N·m/(rad/s)",
           .help = "Drag in proportion to speed; x, y, z, roll, pitch, yaw."});
  v.field("quadratic_drag", c.quadratic_drag,
          {.min = 0,
           .max = 1e7,
           .size = 6,
           .unit = "N/(m/s)², N·m/(rad/s)²",
           .help = "Drag in proportion to speed squared; x, y, z, roll, pitch, yaw."});
  v.field("net_buoyancy_n", c.net_buoyancy_n,
          {.min = -10000, .max = 10000, .unit = "N", .help = "Buoyancy minus weight, upward."});
  v.field(
      "thruster_lag_s", c.thruster_lag_s,
      {.min = 0,
       .max = 10,
       .unit = "s",
       .help =
           "Time constant of the rotors' speed after a command; rather too long than too short."});
}

void describe_loop(Visitor& v, RovConfig& c) {
  v.field("velocity_gain", c.velocity_gain,
          {.min = 0,
           .max = 100,
           .unit = "1/s",
           .help = "Wished acceleration for each m/s of velocity error."});
  v.field("velocity_integral", c.velocity_integral,
          {.min = 0, .max = 100, .unit = "1/s²", .help = "The same for its integral."});
  v.field("rate_gain", c.rate_gain,
          {.min = 0,
           .max = 100,
           .unit = "1/s",
           .help = "Wished angular acceleration for each rad/s of error."});
  v.field("rate_integral", c.rate_integral,
          {.min = 0, .max = 100, .unit = "1/s²", .help = "The same for its integral."});
  v.field("acceleration_smoothing_s", c.acceleration_smoothing_s,
          {.min = 0,
           .max = 10,
           .unit = "s",
           .help = "Smoothing of the wished velocity's derivative, whose force is fed forward; 0 "
                   "feeds none."});
  v.field(
      "slew_n_s", c.slew_n_s,
      {.min = 0.1, .max = 1e6, .unit = "N/s", .help = "Fastest change of one thruster's thrust."});
}

}  // namespace

void describe(Visitor& v, RovConfig& c) {
  v.field("frame", c.frame,
          {.choices = {"vectored", "vectored_6dof", "custom"},
           .help = "Thruster layout: ArduSub's frame of that name, motors in its order, or the "
                   "thruster tables below."});
  v.field("controlled", c.controlled,
          {.choices = {"x", "y", "z", "roll", "pitch", "yaw"},
           .help = "Axes of the body that the thrusters shall move."});
  v.group("curve", c.curve, "Command to thrust, of every thruster of a named frame.");
  v.list("thruster", c.thrusters, "One table for each thruster, with frame = \"custom\".");
  describe_body(v, c);
  describe_loop(v, c);
}

void describe(Visitor& v, VehicleConfig& c) {
  v.field("kind", c.kind,
          {.choices = {"none", "rov", "agv", "arm"},
           .help = "What is moved; \"none\" gives poses only and can never be armed."});
  v.group("rov", c.rov, "An underwater vehicle with thrusters.");
  v.group("agv", c.agv, "A ground vehicle with two driven wheels.");
  v.group("arm", c.arm, "A serial arm with the cameras on its hand, which is the body.");
}

}  // namespace gannet::vehicle
