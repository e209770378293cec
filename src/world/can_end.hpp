// CanEnd: the world's end of the motor bus, and what can happen to that bus: kind "local" (a hub
// over AF_UNIX, where the kernel has no CAN) or "socketcan" (vcan0). vcan has no controller: being
// off the bus or passive is told by the error frames that a controller would give, and while the
// bus is off the world neither hears nor speaks. World's thread alone.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "hal/can/can_bus.hpp"
#include "platform/base/result.hpp"

namespace gannet::world {

struct CanEndConfig {
  std::string kind = "local";  // local | socketcan
  std::string name;            // the hub's socket, or the interface
};

// Brings a network interface up or down; the kernel's by default.
using LinkSwitch = std::function<Result<void>(const std::string& interface, bool up)>;
Result<void> switch_link(const std::string& interface, bool up);

class CanEnd {
 public:
  // Error: the name is in use or there is none of it.
  static Result<std::unique_ptr<CanEnd>> create(const CanEndConfig& config, TimePoint now,
                                                LinkSwitch link = switch_link);
  // A bus that is there already, as tests have one; kind local.
  CanEnd(CanEndConfig config, std::unique_ptr<hal::CanBus> bus, LinkSwitch link);

  void send(std::span<const hal::CanFrame> frames, TimePoint now);
  int receive(std::span<hal::ReceivedCanFrame> frames, TimePoint now);

  // bus_up ends each of the others. Error: the link cannot be switched (no right to, for one).
  void bus_off(TimePoint now);
  void bus_passive(TimePoint now);
  Result<void> bus_down();
  Result<void> bus_up(TimePoint now);

 private:
  enum class Condition : std::uint8_t { kGood, kPassive, kOff, kDown };
  Result<std::unique_ptr<hal::CanBus>> open(TimePoint now) const;
  void tell(std::uint32_t error_class, std::uint8_t controller, std::uint8_t errors, TimePoint now);

  const CanEndConfig config_;
  const LinkSwitch link_;
  std::unique_ptr<hal::CanBus> bus_;  // null: local, and down
  Condition condition_ = Condition::kGood;
};

}  // namespace gannet::world
