#include "src/servo/mission_config.hpp"

namespace gannet::servo {

VisitLimits limits_of(const VisitConfig& visit) {
  return {visit.tolerance_m, from_seconds(visit.hold_s), from_seconds(visit.time_out_s)};
}

void describe(Visitor& v, VisitConfig& c) {
  v.field("model", c.model, {.help = "The target: the name of one of the models."});
  v.field(
      "goal_x_m", c.goal_x_m,
      {.min = -10, .max = 10, .unit = "m", .help = "Wanted target position, hand frame, right."});
  v.field(
      "goal_y_m", c.goal_y_m,
      {.min = -10, .max = 10, .unit = "m", .help = "Wanted target position, hand frame, down."});
  v.field("goal_z_m", c.goal_z_m,
          {.min = 0.05,
           .max = 20,
           .unit = "m",
           .help = "Wanted target position, hand frame, ahead: the stand-off."});
  v.field("tolerance_m", c.tolerance_m,
          {.min = 0.0005,
           .max = 1,
           .unit = "m",
           .help = "Largest distance from the goal that counts as there."});
  v.field("hold_s", c.hold_s,
          {.min = 0,
           .max = 86400,
           .unit = "s",
           .help = "There for so long without a break, then the next visit."});
  v.field("time_out_s", c.time_out_s,
          {.min = 0.1,
           .max = 86400,
           .unit = "s",
           .help = "A visit that is not done by then is given up: nothing is followed until a "
                   "person starts the mission again."});
}

void describe(Visitor& v, MissionConfig& c) {
  v.field("rounds", c.rounds,
          {.min = 1, .max = 10000, .help = "How often the visits are done, one after another."});
  v.list("visit", c.visits, "A target and a goal each; in turn, when a person starts the mission.");
}

}  // namespace gannet::servo
