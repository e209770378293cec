// The drives' parameters, described once. Start-up only.
#pragma once

#include <string>
#include <vector>

#include "hal/drive/cia402_config.hpp"
#include "hal/drive/dronecan_config.hpp"
#include "hal/drive/odrive_config.hpp"
#include "hal/drive/vesc_config.hpp"
#include "platform/base/describe.hpp"

namespace gannet::hal {

struct MotorConfig {
  int index = 0;
  int node_id = 1;
  bool reversed = false;
  double max_command = 1;
  int pole_pairs = 1;
  bool has_feedback = true;
  double full_speed_rad_s = 300;
};

struct DriveConfig {
  std::string kind = "dronecan_esc";
  int own_node_id = 10;
  std::string range = "reversible";
  double command_period_s = 0;
  double feedback_timeout_s = 0.5;
  double node_timeout_s = 3;
  bool arming_status = true;
  DroneCanConfig dronecan;
  Cia402Config cia402;
  VescConfig vesc;
  OdriveConfig odrive;
  std::vector<MotorConfig> motors;
};

void describe(Visitor& v, MotorConfig& c);
void describe(Visitor& v, DriveConfig& c);

}  // namespace gannet::hal
