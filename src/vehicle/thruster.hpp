// Thrusters as data and as a curve: where ArduSub's frames have them, and how command and thrust
// belong together. RT safe but thrusters_of, which is start-up only.
#pragma once

#include <vector>

#include "platform/base/result.hpp"
#include "src/vehicle/vehicle_config.hpp"

namespace gannet::vehicle {

// Thrust in N of a command in −1 … 1, and the command that makes a thrust; commands are clamped to
// the curve's limit. RT safe.
double thrust_of(const CurveConfig& curve, double command);
double command_for(const CurveConfig& curve, double thrust_n);

// The thrusters of a config: those of its named frame in ArduSub's motor order (motor 1 first), or
// its own table; checked. Start-up only.
Result<std::vector<ThrusterConfig>> thrusters_of(const RovConfig& config);

}  // namespace gannet::vehicle
