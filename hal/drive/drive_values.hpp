// What a vehicle says to its drives and hears from them, free of any protocol. Values; RT safe.
#pragma once

#include <cstdint>
#include <limits>

#include "platform/base/time.hpp"

namespace gannet::hal {

enum class DriveState : std::uint8_t { kUnknown, kDisabled, kEnabled, kFault };

// One motor's wish: value is the fraction −1 … 1 of the motor's full scale, by the vehicle's sign,
// whatever the protocol. What full scale is, the config says: full throttle for an ESC, and
// drive.motor.full_speed_rad_s for a drive that is commanded a speed.
struct DriveSetpoint {
  double value = 0;
};

struct DriveFeedback {
  DriveState state = DriveState::kUnknown;
  TimePoint time = {};     // of the last feedback; the epoch when there was none
  double speed_rad_s = 0;  // of the shaft, by the vehicle's sign
  // Of the same shaft, over all its turns; NaN where the drive does not tell it.
  double position_rad = std::numeric_limits<double>::quiet_NaN();
  double current_a = 0;
  double voltage_v = 0;
  double temperature_k = 0;
  std::uint32_t error_count = 0;  // the drive's own
  std::uint16_t fault_code = 0;   // 0: none; the protocol's word otherwise
};

}  // namespace gannet::hal
