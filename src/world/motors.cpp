#include "src/world/motors.hpp"

#include <cstddef>

namespace gannet::world {
namespace {

constexpr double kBattery_v = 16;
constexpr double kBatteryResistance_ohm = 0.01;

}  // namespace

Result<std::unique_ptr<Motors>> Motors::create(const std::string& bus,
                                               const hal::DriveConfig& drives, Duration delay,
                                               std::uint64_t seed) {
  auto hub = hal::LocalCanHub::listen(bus);
  if (!hub) return hub.error();
  auto nodes = make_motor_nodes(drives, seed);
  if (!nodes) return nodes.error();
  return std::unique_ptr<Motors>(new Motors(std::move(*hub), std::move(*nodes), delay));
}

Motors::Motors(std::unique_ptr<hal::LocalCanHub> hub, std::unique_ptr<MotorNodes> nodes,
               Duration delay)
    : hub_(std::move(hub)),
      nodes_(std::move(nodes)),
      delay_(delay),
      throttles_(static_cast<std::size_t>(nodes_->motors()), 0.0) {}

void Motors::step(TimePoint now, RovPlant& plant) {
  receive(now);
  heard_.clear();
  while (!delayed_.empty() && delayed_.front().due <= now) {
    heard_.push_back(delayed_.front().frame);
    delayed_.pop_front();
  }
  report(plant);
  said_.clear();
  const std::span<const double> throttles = nodes_->step(now, heard_, said_);
  throttles_.assign(throttles.begin(), throttles.end());
  plant.command(throttles_);
  hub_->send(said_, now);
}

void Motors::receive(TimePoint now) {
  std::array<hal::ReceivedCanFrame, 64> frames;
  while (true) {
    const int count = hub_->receive(frames, now);
    for (int i = 0; i < count; ++i)
      delayed_.push_back({now + delay_, frames[static_cast<std::size_t>(i)].frame});
    if (count < static_cast<int>(frames.size())) return;
  }
}

void Motors::report(const RovPlant& plant) {
  double current = 0;
  for (const Thruster& thruster : plant.thrusters()) current += thruster.current_a();
  for (int i = 0; i < nodes_->motors(); ++i) {
    const Thruster& thruster = plant.thrusters()[static_cast<std::size_t>(i)];
    nodes_->report(i, {.speed_rad_s = thruster.speed_rad_s(),
                       .current_a = thruster.current_a(),
                       .voltage_v = kBattery_v - kBatteryResistance_ohm * current});
  }
}

}  // namespace gannet::world
