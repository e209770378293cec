#include "src/world/can_end.hpp"

#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <utility>

#include "hal/can/local_bus.hpp"
#include "hal/can/socketcan_bus.hpp"
#include "platform/linux/fd.hpp"

namespace gannet::world {
namespace {

// Bits of an error frame, as linux/can/error.h has them; a test reads them back with the daemon's
// own decoder.
constexpr std::uint32_t kController = 0x004, kBusOff = 0x040, kRestarted = 0x100,
                        kHasCounters = 0x200;
constexpr std::uint8_t kTransmitPassive = 0x20, kActive = 0x40;
constexpr std::uint8_t kPassiveErrors = 136;

template <class Bus>
Result<std::unique_ptr<hal::CanBus>> as_bus(Result<std::unique_ptr<Bus>> made) {
  if (!made) return made.error();
  return std::unique_ptr<hal::CanBus>(std::move(*made));
}

}  // namespace

Result<void> switch_link(const std::string& interface, bool up) {
  const std::string what = "CAN interface '" + interface + "'";
  // Any socket can ask; a local one needs no protocol of the kernel.
  const linux_os::Fd fd(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  ifreq request = {};
  interface.copy(request.ifr_name, IFNAMSIZ - 1);
  if (!fd.valid() || ioctl(fd.get(), SIOCGIFFLAGS, &request) != 0)
    return linux_os::system_error(what, errno);
  const int flags = static_cast<unsigned short>(request.ifr_flags);
  request.ifr_flags = static_cast<short>(up ? flags | IFF_UP : flags & ~IFF_UP);
  if (ioctl(fd.get(), SIOCSIFFLAGS, &request) != 0)
    return linux_os::system_error(what + (up ? " cannot go up" : " cannot go down"), errno);
  return {};
}

Result<std::unique_ptr<hal::CanBus>> CanEnd::open(TimePoint now) const {
  if (config_.kind == "local") return as_bus(hal::LocalCanHub::listen(config_.name));
  return as_bus(hal::SocketCanBus::open(config_.name, {}, 0, now));
}

Result<std::unique_ptr<CanEnd>> CanEnd::create(const CanEndConfig& config, TimePoint now,
                                               LinkSwitch link) {
  auto end = std::make_unique<CanEnd>(config, nullptr, std::move(link));
  auto bus = end->open(now);
  if (!bus) return bus.error();
  end->bus_ = std::move(*bus);
  return end;
}

CanEnd::CanEnd(CanEndConfig config, std::unique_ptr<hal::CanBus> bus, LinkSwitch link)
    : config_(std::move(config)), link_(std::move(link)), bus_(std::move(bus)) {}

void CanEnd::send(std::span<const hal::CanFrame> frames, TimePoint now) {
  if (bus_ && condition_ != Condition::kOff) bus_->send(frames, now);
}

int CanEnd::receive(std::span<hal::ReceivedCanFrame> frames, TimePoint now) {
  const int count = bus_ ? bus_->receive(frames, now) : 0;
  // Off the bus nothing arrives; what the daemon still says is read and lost.
  return condition_ == Condition::kOff ? 0 : count;
}

void CanEnd::tell(std::uint32_t error_class, std::uint8_t controller, std::uint8_t errors,
                  TimePoint now) {
  hal::CanFrame frame;
  frame.error = true;
  frame.id = error_class;
  frame.length = 8;
  frame.data[1] = controller;
  frame.data[6] = errors;
  if (bus_) bus_->send({&frame, 1}, now);
}

void CanEnd::bus_off(TimePoint now) {
  tell(kBusOff, 0, 0, now);
  condition_ = Condition::kOff;
}

void CanEnd::bus_passive(TimePoint now) {
  tell(kController | kHasCounters, kTransmitPassive, kPassiveErrors, now);
  condition_ = Condition::kPassive;
}

Result<void> CanEnd::bus_down() {
  condition_ = Condition::kDown;
  if (config_.kind != "local") return link_(config_.name, false);
  bus_.reset();
  return {};
}

Result<void> CanEnd::bus_up(TimePoint now) {
  const Condition before = std::exchange(condition_, Condition::kGood);
  if (before == Condition::kOff) tell(kRestarted, 0, 0, now);
  if (before == Condition::kPassive) tell(kController | kHasCounters, kActive, 0, now);
  if (before != Condition::kDown) return {};
  if (config_.kind != "local") return link_(config_.name, true);
  auto bus = open(now);
  if (!bus) return bus.error();
  bus_ = std::move(*bus);
  return {};
}

}  // namespace gannet::world
