#include "src/servo/servo_config.hpp"

#include <numbers>

namespace gannet::servo {

Goal goal_of(const ServoParams& p) {
  constexpr double kRadians = std::numbers::pi / 180;
  return {{quaternion_from_rpy(p.goal_roll_deg * kRadians, p.goal_pitch_deg * kRadians,
                               p.goal_yaw_deg * kRadians),
           {p.goal_x_m, p.goal_y_m, p.goal_z_m}}};
}

namespace {

void describe_limits(Visitor& v, ServoParams& p) {
  v.field("position_gain", p.position_gain,
          {.min = 0, .max = 20, .unit = "1/s", .help = "Approach speed for each metre of error."});
  v.field("rotation_gain", p.rotation_gain,
          {.min = 0, .max = 20, .unit = "1/s", .help = "Rate of turn for each radian of error."});
  v.field("max_speed_m_s", p.max_speed_m_s,
          {.min = 0.001,
           .max = 10,
           .unit = "m/s",
           .help = "Fastest approach; the target's own motion is added."});
  v.field("max_rate_rad_s", p.max_rate_rad_s,
          {.min = 0.001,
           .max = 10,
           .unit = "rad/s",
           .help = "Fastest turn; the target's own is added."});
  v.field(
      "max_acceleration_m_s2", p.max_acceleration_m_s2,
      {.min = 0.001, .max = 100, .unit = "m/s²", .help = "Largest change of the wished velocity."});
  v.field("max_acceleration_rad_s2", p.max_acceleration_rad_s2,
          {.min = 0.001,
           .max = 100,
           .unit = "rad/s²",
           .help = "Largest change of the wished rate of turn."});
  v.field("feed_forward", p.feed_forward,
          {.help = "Move with the target by its estimated velocity; without it a moving target "
                   "is followed with a lag."});
}

void describe_goal(Visitor& v, ServoParams& p) {
  v.field(
      "goal_x_m", p.goal_x_m,
      {.min = -10, .max = 10, .unit = "m", .help = "Wanted target position, hand frame, right."});
  v.field(
      "goal_y_m", p.goal_y_m,
      {.min = -10, .max = 10, .unit = "m", .help = "Wanted target position, hand frame, down."});
  v.field(
      "goal_z_m", p.goal_z_m,
      {.min = 0.05, .max = 20, .unit = "m", .help = "Wanted target position, hand frame, ahead."});
  v.field("goal_roll_deg", p.goal_roll_deg,
          {.min = -180,
           .max = 180,
           .unit = "deg",
           .help = "Wanted target orientation about the hand's x; R = Rz·Ry·Rx."});
  v.field("goal_pitch_deg", p.goal_pitch_deg,
          {.min = -89, .max = 89, .unit = "deg", .help = "The same about the hand's y."});
  v.field("goal_yaw_deg", p.goal_yaw_deg,
          {.min = -180, .max = 180, .unit = "deg", .help = "The same about the hand's z."});
  v.field("near_m", p.near_m,
          {.min = 0,
           .max = 20,
           .unit = "m",
           .help = "follow_person: nearer than this it never drives, and between this and the "
                   "goal's distance ever more slowly."});
}

void describe_axes(Visitor& v, ServoParams& p) {
  v.field("control_x", p.control_x, {.help = "Move the body forward and backward."});
  v.field("control_y", p.control_y, {.help = "Move the body sideways."});
  v.field("control_z", p.control_z, {.help = "Move the body up and down."});
  v.field("control_roll", p.control_roll, {.help = "Turn the body about its forward axis."});
  v.field("control_pitch", p.control_pitch, {.help = "Turn the body about its left axis."});
  v.field("control_yaw", p.control_yaw, {.help = "Turn the body about its upward axis."});
}

}  // namespace

void describe(Visitor& v, ServoConfig& c) {
  v.field("law", c.law,
          {.choices = {"pose_regulation", "follow_person"},
           .help = "How errors become motion: to a pose, or behind somebody at the goal's distance "
                   "and bearing."});
  describe_limits(v, c.params);
  describe_goal(v, c.params);
  describe_axes(v, c.params);
}

}  // namespace gannet::servo
