#include "src/world/thruster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace gannet::world {
namespace {

// The published table at every 40 µs: throttle, revolutions per minute, newtons, amperes. The rows
// beside the dead band are the last that turn.
struct Row {
  double throttle, rpm, thrust_n, current_a;
};
constexpr std::array<Row, 12> kForward = {{{0.07, 0, 0, 0},
                                           {0.08, 308.25, 0.400, 0.05},
                                           {0.1, 440.8, 0.756, 0.05},
                                           {0.2, 1007.4, 3.916, 0.4},
                                           {0.3, 1443.5, 8.010, 1.2},
                                           {0.4, 1802.3, 12.548, 2.6},
                                           {0.5, 2128.7, 17.888, 4.58},
                                           {0.6, 2446.0, 23.851, 7.0},
                                           {0.7, 2735.5, 30.481, 10.4},
                                           {0.8, 3041.9, 37.467, 13.99},
                                           {0.9, 3307.8, 45.610, 19.13},
                                           {1.0, 3533.4, 51.454, 23.83}}};
constexpr std::array<Row, 12> kReverse = {{{0.07, 0, 0, 0},
                                           {0.08, 317.2, 0.356, 0.05},
                                           {0.1, 449.5, 0.667, 0.05},
                                           {0.2, 1016.5, 3.159, 0.4},
                                           {0.3, 1448.5, 6.363, 1.2},
                                           {0.4, 1807.4, 10.012, 2.4},
                                           {0.5, 2140.2, 14.106, 4.4},
                                           {0.6, 2440.2, 19.045, 6.89},
                                           {0.7, 2736.4, 24.073, 10.27},
                                           {0.8, 3003.3, 29.368, 14.04},
                                           {0.9, 3282.3, 35.865, 19.32},
                                           {1.0, 3464.7, 39.922, 24.30}}};
constexpr double kRadPerSecond = 2 * 3.14159265358979323846 / 60;  // of one rpm

const std::array<Row, 12>& table(double sign) { return sign < 0 ? kReverse : kForward; }

// Linear between rows, by the column `from`, of the column `to`; x >= 0.
double look_up(const std::array<Row, 12>& rows, double Row::*from, double Row::*to, double x) {
  if (x <= rows.front().*from) return rows.front().*to;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (x > rows[i].*from) continue;
    const Row& a = rows[i - 1];
    const Row& b = rows[i];
    return a.*to + (b.*to - a.*to) * (x - a.*from) / (b.*from - a.*from);
  }
  return rows.back().*to;
}

}  // namespace

double steady_speed_rad_s(double throttle) {
  const double rpm = look_up(table(throttle), &Row::throttle, &Row::rpm, std::abs(throttle));
  return std::copysign(rpm * kRadPerSecond, throttle);
}

double throttle_at_speed(double speed_rad_s) {
  double low = 0, high = 1;  // the thruster's table only rises
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    const double speed = steady_speed_rad_s(std::copysign(middle, speed_rad_s));
    (std::fabs(speed) < std::fabs(speed_rad_s) ? low : high) = middle;
  }
  return speed_rad_s == 0 ? 0 : std::copysign(high, speed_rad_s);
}

double thrust_at_speed_n(double speed_rad_s) {
  const double rpm = std::abs(speed_rad_s) / kRadPerSecond;
  const auto& rows = table(speed_rad_s);
  // Below the slowest speed that was measured, thrust goes with its square.
  const double slowest = rows[1].rpm;
  const double thrust = rpm < slowest ? rows[1].thrust_n * (rpm / slowest) * (rpm / slowest)
                                      : look_up(rows, &Row::rpm, &Row::thrust_n, rpm);
  return std::copysign(thrust, speed_rad_s);
}

void Thruster::command(double throttle) {
  throttle_ = std::isnan(throttle) ? 0 : std::clamp(throttle, -1.0, 1.0);
}

void Thruster::advance(double dt_s) {
  const double wanted = jammed_ ? 0 : steady_speed_rad_s(throttle_);
  // Exact for a command that stays, so that the step's length does not change the lag.
  speed_rad_s_ += (wanted - speed_rad_s_) * (1 - std::exp(-dt_s / kThrusterLag_s));
  if (jammed_) speed_rad_s_ = 0;
  position_rad_ += speed_rad_s_ * dt_s;
}

double Thruster::current_a() const {
  return look_up(table(speed_rad_s_), &Row::rpm, &Row::current_a,
                 std::abs(speed_rad_s_) / kRadPerSecond);
}

}  // namespace gannet::world
