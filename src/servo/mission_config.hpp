// Parameters of a mission, described once. describe: start-up only.
#pragma once

#include <string>
#include <vector>

#include "platform/base/describe.hpp"
#include "src/servo/mission.hpp"

namespace gannet::servo {

struct VisitConfig {
  std::string model;  // its name
  // The goal: target in Σ_H.
  double goal_x_m = 0;
  double goal_y_m = 0;
  double goal_z_m = 0.5;
  double tolerance_m = 0.02;
  double hold_s = 5;
  double time_out_s = 60;
};

struct MissionConfig {
  int rounds = 1;
  std::vector<VisitConfig> visits;
};

VisitLimits limits_of(const VisitConfig& visit);  // RT safe

void describe(Visitor& v, VisitConfig& c);
void describe(Visitor& v, MissionConfig& c);

}  // namespace gannet::servo
