#include "src/world/motors.hpp"

#include <cstddef>

#include "hal/drive/dronecan_messages.hpp"

namespace gannet::world {
namespace {

using hal::dronecan::ArmingStatus;

constexpr double kBattery_v = 16;
constexpr double kBatteryResistance_ohm = 0.01;
constexpr int kListenerId = 127;  // speaks to nobody; requests to it do not exist

}  // namespace

Result<std::unique_ptr<Motors>> Motors::create(const std::string& bus,
                                               const hal::DriveConfig& drives, Duration delay,
                                               std::uint64_t seed) {
  auto hub = hal::LocalCanHub::listen(bus);
  if (!hub) return hub.error();
  return std::unique_ptr<Motors>(new Motors(std::move(*hub), drives, delay, seed));
}

Motors::Motors(std::unique_ptr<hal::LocalCanHub> hub, const hal::DriveConfig& drives,
               Duration delay, std::uint64_t seed)
    : hub_(std::move(hub)),
      nodes_(drives, {}, seed),
      delay_(delay),
      ear_({hal::dronecan::subscription_to<ArmingStatus>()}, kListenerId, 4),
      throttles_(drives.motors.size(), 0.0) {}

void Motors::step(TimePoint now, RovPlant& plant) {
  receive(now);
  heard_.clear();
  while (!delayed_.empty() && delayed_.front().due <= now) {
    heard_.push_back(delayed_.front().frame);
    delayed_.pop_front();
  }
  for (const hal::CanFrame& frame : heard_) listen_for_arming(frame, now);
  report(plant);
  said_.clear();
  const std::span<const double> throttles = nodes_.step(now, heard_, said_);
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

void Motors::listen_for_arming(const hal::CanFrame& frame, TimePoint now) {
  const auto transfer = ear_.receive(frame, now);
  ArmingStatus status;
  if (transfer && hal::dronecan::decode(transfer->payload, status))
    armed_ = status.status == ArmingStatus::kArmed;
}

void Motors::report(const RovPlant& plant) {
  double current = 0;
  for (const Thruster& thruster : plant.thrusters()) current += thruster.current_a();
  for (int i = 0; i < nodes_.motors(); ++i) {
    const Thruster& thruster = plant.thrusters()[static_cast<std::size_t>(i)];
    nodes_.report(i, {.speed_rad_s = thruster.speed_rad_s(),
                      .current_a = thruster.current_a(),
                      .voltage_v = kBattery_v - kBatteryResistance_ohm * current});
  }
}

}  // namespace gannet::world
