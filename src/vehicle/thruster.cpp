#include "src/vehicle/thruster.hpp"

#include <algorithm>
#include <cmath>

namespace gannet::vehicle {
namespace {

ThrusterConfig at(double x, double y, double z, double forward, double left, double up,
                  const CurveConfig& curve) {
  return {{x, y, z}, {forward, left, up}, curve};
}

// Directions are ArduSub's motor factors (ArduPilot, libraries/AP_Motors/AP_Motors6DOF.cpp,
// SUB_FRAME_VECTORED and SUB_FRAME_VECTORED_6DOF; its lateral factor is to the right, its throttle
// factor upward): motors 1 to 4 front right, front left, rear right, rear left; the vertical ones
// right and left, or front right, front left, rear right, rear left.
// Positions: vectored as in the BlueROV2 model bluerov2_gz, vectored_6dof as von Benzon et al.
// 2022, Table A1, has the Heavy's.
std::vector<ThrusterConfig> horizontal(double x, double y, double z, const CurveConfig& c) {
  return {at(x, -y, z, -1, -1, 0, c), at(x, y, z, -1, 1, 0, c), at(-x, -y, z, 1, -1, 0, c),
          at(-x, y, z, 1, 1, 0, c)};
}

std::vector<ThrusterConfig> vectored(const CurveConfig& c) {
  auto all = horizontal(0.14, 0.092, 0, c);
  for (const double y : {-0.109, 0.109}) all.push_back(at(0, y, 0.077, 0, 0, -1, c));
  return all;
}

std::vector<ThrusterConfig> vectored_6dof(const CurveConfig& c) {
  auto all = horizontal(0.156, 0.111, -0.085, c);
  for (const double x : {0.12, -0.12}) {
    for (const double y : {-0.218, 0.218}) all.push_back(at(x, y, 0, 0, 0, -1, c));
  }
  return all;
}

Result<void> check(const ThrusterConfig& t, const std::string& name) {
  if (t.position_m.size() != 3 || t.direction.size() != 3) {
    return Error{name + ": position_m and direction need three numbers each"};
  }
  const double length = std::hypot(t.direction[0], t.direction[1], t.direction[2]);
  if (!(length > 1e-6)) return Error{name + ": direction has no length"};
  return {};
}

}  // namespace

double thrust_of(const CurveConfig& curve, double command) {
  const double used = std::min(std::abs(command), curve.limit);
  if (!(used > curve.dead_band)) return 0;
  const double share = std::pow((used - curve.dead_band) / (1 - curve.dead_band), curve.exponent);
  return command > 0 ? share * curve.max_forward_n : -share * curve.max_backward_n;
}

double command_for(const CurveConfig& curve, double thrust_n) {
  const double share =
      std::abs(thrust_n) / (thrust_n > 0 ? curve.max_forward_n : curve.max_backward_n);
  // Below a millionth of its thrust a motor rests rather than humming at the dead band's edge.
  if (!(share > 1e-6)) return 0;
  const double command =
      curve.dead_band + (1 - curve.dead_band) * std::pow(share, 1 / curve.exponent);
  return std::copysign(std::min(command, curve.limit), thrust_n);
}

Result<std::vector<ThrusterConfig>> thrusters_of(const RovConfig& config) {
  if (config.frame == "vectored") return vectored(config.curve);
  if (config.frame == "vectored_6dof") return vectored_6dof(config.curve);
  if (config.frame != "custom") {
    return Error{"vehicle.rov.frame: unknown frame '" + config.frame +
                 "'; known: vectored, vectored_6dof, custom"};
  }
  if (config.thrusters.empty()) {
    return Error{"vehicle.rov: frame \"custom\" needs at least one [[vehicle.rov.thruster]]"};
  }
  for (std::size_t i = 0; i < config.thrusters.size(); ++i) {
    const auto checked =
        check(config.thrusters[i], "vehicle.rov.thruster[" + std::to_string(i) + "]");
    if (!checked) return checked.error();
  }
  return config.thrusters;
}

}  // namespace gannet::vehicle
