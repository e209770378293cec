#include "src/vehicle/agv_config.hpp"

namespace gannet::vehicle {
namespace {

void describe_limits(Visitor& v, AgvConfig& c) {
  v.field("max_wheel_speed_rad_s", c.max_wheel_speed_rad_s,
          {.min = 0.1, .max = 500, .unit = "rad/s", .help = "Fastest turn of a wheel."});
  v.field("max_acceleration_m_s2", c.max_acceleration_m_s2,
          {.min = 0.01, .max = 20, .unit = "m/s²", .help = "Of its speed, both ways."});
  v.field("max_jerk_m_s3", c.max_jerk_m_s3,
          {.min = 0.01, .max = 1000, .unit = "m/s³", .help = "Fastest change of that."});
  v.field("max_acceleration_rad_s2", c.max_acceleration_rad_s2,
          {.min = 0.01, .max = 100, .unit = "rad/s²", .help = "Of its rate of turn."});
  v.field("max_jerk_rad_s3", c.max_jerk_rad_s3,
          {.min = 0.01, .max = 10000, .unit = "rad/s³", .help = "Fastest change of that."});
  v.field("hold_deceleration_m_s2", c.hold_deceleration_m_s2,
          {.min = 0.01,
           .max = 20,
           .unit = "m/s²",
           .help = "How it slows down while it may only hold, as when its target is lost. Without "
                   "a permit its wheels are told to stop at once."});
}

}  // namespace

void describe(Visitor& v, AgvConfig& c) {
  v.field("wheel_radius_m", c.wheel_radius_m,
          {.min = 0.005, .max = 2, .unit = "m", .help = "Of the driven wheels, under load."});
  v.field("track_m", c.track_m,
          {.min = 0.02,
           .max = 10,
           .unit = "m",
           .help = "Between the driven wheels' lines of contact."});
  v.field("gear_ratio", c.gear_ratio,
          {.min = 0.01,
           .max = 1000,
           .help = "Turns of the shaft that the drive speaks of for one of the wheel."});
  describe_limits(v, c);
  v.field("rear_free", c.rear_free,
          {.help = "It may drive backwards; false: it never does, whoever asks."});
  v.field("feedback_age_s", c.feedback_age_s,
          {.min = 0.001,
           .max = 5,
           .unit = "s",
           .help = "Oldest report of a wheel's speed that counts as its own motion; without one, "
                   "what was commanded does."});
}

}  // namespace gannet::vehicle
