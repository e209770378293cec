#include "src/world/motors.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace gannet::world {
namespace {

constexpr double kBattery_v = 16;
constexpr double kBatteryResistance_ohm = 0.01;
// A bus that has been silent for so long commands nobody, whatever was said before.
constexpr Duration kSilence = std::chrono::milliseconds(100);

}  // namespace

Result<std::unique_ptr<Motors>> Motors::create(std::unique_ptr<CanEnd> bus,
                                               const hal::DriveConfig& drives, Duration delay,
                                               std::uint64_t seed) {
  auto nodes = make_motor_nodes(drives, seed);
  if (!nodes) return nodes.error();
  return std::unique_ptr<Motors>(new Motors(std::move(bus), std::move(*nodes), delay));
}

Motors::Motors(std::unique_ptr<CanEnd> bus, std::unique_ptr<MotorNodes> nodes, Duration delay)
    : bus_(std::move(bus)),
      nodes_(std::move(nodes)),
      delay_(delay),
      throttles_(static_cast<std::size_t>(nodes_->motors()), 0.0) {}

void Motors::step(TimePoint now, Plant& plant) {
  receive(now);
  report(plant);
  said_.clear();
  TimePoint reached = last_step_;
  while (!delayed_.empty() && delayed_.front().due <= now) {
    reached = delayed_.front().due;
    heard_.clear();
    for (; !delayed_.empty() && delayed_.front().due == reached; delayed_.pop_front())
      heard_.push_back(delayed_.front().frame);
    obey(reached, reached - delay_);
  }
  heard_.clear();
  if (reached < now) obey(now, now);
  last_step_ = now;
  plant.command(throttles_);
  bus_->send(said_, now);
}

// told: when the bus had what was heard.
void Motors::obey(TimePoint due, TimePoint told) {
  const std::span<const double> throttles = nodes_->step(due, heard_, said_);
  throttles_.assign(throttles.begin(), throttles.end());
  if (!heard_.empty()) last_heard_ = due;
  const bool commanded = nodes_->armed() && due - last_heard_ < kSilence;
  const bool turning =
      std::any_of(throttles_.begin(), throttles_.end(), [](double t) { return t != 0; });
  const bool was_still = turns_.empty() || turns_.back().still;
  const bool still = !turning && (was_still || !commanded);
  if (turns_.empty() || was_still != still) turns_.push_back({told, still});
}

void Motors::receive(TimePoint now) {
  std::array<hal::ReceivedCanFrame, 64> frames;
  while (true) {
    const int count = bus_->receive(frames, now);
    for (const hal::ReceivedCanFrame& received :
         std::span(frames).first(static_cast<std::size_t>(count))) {
      // In order and never before what the nodes have lived through: stamps are the kernel's.
      const TimePoint least = delayed_.empty() ? last_step_ : delayed_.back().due;
      delayed_.push_back({std::max(received.time + delay_, least), received.frame});
    }
    if (count < static_cast<int>(frames.size())) return;
  }
}

void Motors::report(const Plant& plant) {
  double current = 0;
  for (int i = 0; i < plant.motors(); ++i) current += plant.motor(i).current_a;
  for (int i = 0; i < nodes_->motors(); ++i) {
    const MotorState motor = plant.motor(i);
    nodes_->report(i, {.speed_rad_s = motor.speed_rad_s,
                       .current_a = motor.current_a,
                       .voltage_v = kBattery_v - kBatteryResistance_ohm * current,
                       .position_rad = motor.position_rad});
  }
}

}  // namespace gannet::world
