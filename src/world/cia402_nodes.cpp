#include "src/world/cia402_nodes.hpp"

#include <cmath>

#include "src/world/thruster.hpp"

namespace gannet::world {

namespace {

constexpr std::uint16_t kFaultCode = 0x4310;  // of a drive that is made faulty: it is too hot

}  // namespace

Cia402Nodes::Cia402Nodes(const hal::DriveConfig& drives, std::uint64_t seed)
    : throttles_(drives.motors.size()), random_(seed) {
  const double units = hal::velocity_units_per_rad_s(drives.cia402);
  const double increments = hal::position_units_per_rad(drives.cia402);
  for (const hal::MotorConfig& motor : drives.motors) {
    const auto base = static_cast<std::uint32_t>(0x100 + 0x100 * drives.cia402.pdo);
    drives_.push_back({.node = Cia402Node(motor.node_id),
                       .command_id = base + static_cast<std::uint32_t>(motor.node_id),
                       .units_per_rad_s = motor.reversed ? -units : units,
                       .increments_per_rad = motor.reversed ? -increments : increments,
                       .faults = {},
                       .mouth = {}});
  }
}

void Cia402Nodes::report(int motor, const MotorReport& report) {
  Drive& drive = at(motor);
  drive.node.measure(report.speed_rad_s * drive.units_per_rad_s, report.current_a * 1000,
                     report.voltage_v * 1000, report.position_rad * drive.increments_per_rad);
}

// Whoever hears: also what a silent drive does not.
void Cia402Nodes::listen_for_arming(const hal::CanFrame& frame) {
  if (frame.extended || frame.length < 2) return;
  for (const Drive& drive : drives_) {
    if (frame.id == drive.command_id) armed_ = (frame.data[0] & 0x8F) == 0x0F;
  }
}

std::span<const double> Cia402Nodes::step(TimePoint now, std::span<const hal::CanFrame> in,
                                          std::vector<hal::CanFrame>& out) {
  for (const hal::CanFrame& frame : in) listen_for_arming(frame);
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    Drive& drive = drives_[i];
    if (!has_begun_) drive.node.power_on(now);
    drive.node.set_fault(drive.faults.faulty ? kFaultCode : 0);
    // A silent drive goes on: its guard of the master stops it.
    for (const hal::CanFrame& frame : in) {
      if (!drive.faults.silent) drive.node.hear(frame, now);
    }
    drive.node.step(now);
    for (const hal::CanFrame& frame : drive.node.take_said()) {
      drive.mouth.say(frame, drive.faults, random_, now);
    }
    drive.mouth.deliver(drive.faults, now, out);
    throttles_[i] = throttle_at_speed(drive.node.demand() / drive.units_per_rad_s);
  }
  has_begun_ = true;
  return throttles_;
}

}  // namespace gannet::world
