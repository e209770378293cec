#include "src/track/filter_config.hpp"

namespace gannet::track {

void describe(Visitor& v, FilterConfig& c) {
  v.field("predict", c.predict,
          {.help = "Predict poses to now; false passes on the pose at the image's time."});
  v.field("acceleration_density", c.acceleration_density,
          {.min = 1e-4,
           .max = 100,
           .unit = "m/s²/√Hz",
           .help = "How freely the target's velocity changes (white acceleration)."});
  v.field("angular_acceleration_density", c.angular_acceleration_density,
          {.min = 1e-4,
           .max = 100,
           .unit = "rad/s²/√Hz",
           .help = "How freely the target's rate of turn changes."});
  v.field("initial_speed_m_s", c.initial_speed_m_s,
          {.min = 0.001,
           .max = 10,
           .unit = "m/s",
           .help = "Standard deviation of the target's speed when it is first seen."});
  v.field("initial_rate_rad_s", c.initial_rate_rad_s,
          {.min = 0.001,
           .max = 10,
           .unit = "rad/s",
           .help = "Standard deviation of its rate of turn when it is first seen."});
  v.field("least_sigma_m", c.least_sigma_m,
          {.min = 1e-6,
           .max = 0.1,
           .unit = "m",
           .help = "No measured position is trusted beyond this."});
  v.field("least_sigma_rad", c.least_sigma_rad,
          {.min = 1e-6,
           .max = 0.5,
           .unit = "rad",
           .help = "No measured orientation is trusted beyond this."});
  v.field("gate", c.gate,
          {.min = 6,
           .max = 10000,
           .help = "Largest squared Mahalanobis distance of a measurement that is believed; 35 "
                   "refuses 4 of a million good ones."});
  v.field("rejections_to_reset", c.rejections_to_reset,
          {.min = 1, .max = 1000, .help = "Refused in a row before the filter starts anew."});
  v.field("longest_gap_s", c.longest_gap_s,
          {.min = 0.05,
           .max = 60,
           .unit = "s",
           .help = "Between measurements; after a longer one the filter starts anew."});
  v.field(
      "longest_prediction_s", c.longest_prediction_s,
      {.min = 0.05, .max = 60, .unit = "s", .help = "A prediction farther ahead is not valid."});
}

}  // namespace gannet::track
