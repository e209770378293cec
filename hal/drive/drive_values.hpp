// What a vehicle says to its drives and hears from them, free of any protocol. Values; RT safe.
#pragma once

#include <cstdint>

#include "platform/base/time.hpp"

namespace gannet::hal {

enum class DriveState : std::uint8_t { kUnknown, kDisabled, kEnabled, kFault };

// One motor's wish. The unit of value is the drive's, fixed by its kind and said in its config:
// thrust fraction −1 … 1 for an ESC, rad/s for a velocity drive.
struct DriveSetpoint {
  double value = 0;
};

struct DriveFeedback {
  DriveState state = DriveState::kUnknown;
  TimePoint time = {};     // of the last feedback; the epoch when there was none
  double speed_rad_s = 0;  // of the shaft, by the vehicle's sign
  double current_a = 0;
  double voltage_v = 0;
  double temperature_k = 0;
  std::uint32_t error_count = 0;  // the drive's own
  std::uint16_t fault_code = 0;   // 0: none; the protocol's word otherwise
};

}  // namespace gannet::hal
