#include "hal/can/can_wire.hpp"

#include <algorithm>
#include <cstring>

namespace gannet::hal {
namespace {
constexpr std::uint32_t kExtendedFlag = 0x80000000, kRemoteFlag = 0x40000000,
                        kErrorFlag = 0x20000000;
}  // namespace

CanWire to_wire(const CanFrame& frame) {
  CanWire wire = {};
  const std::uint32_t id =
      frame.id | (frame.extended ? kExtendedFlag : 0) | (frame.error ? kErrorFlag : 0);
  std::memcpy(wire.data(), &id, sizeof id);  // host byte order, as the kernel has it
  wire[4] = frame.length;
  std::copy_n(frame.data.begin(), std::min<int>(frame.length, 8), wire.begin() + 8);
  return wire;
}

bool from_wire(std::span<const std::uint8_t> wire, CanFrame& frame) {
  if (wire.size() != kCanWireBytes) return false;
  std::uint32_t id = 0;
  std::memcpy(&id, wire.data(), sizeof id);
  frame = {};
  frame.extended = (id & kExtendedFlag) != 0;
  frame.error = (id & kErrorFlag) != 0;
  frame.id = id & kMaxExtendedId;
  frame.length = wire[4];
  if ((id & kRemoteFlag) != 0 || frame.length > 8) return false;
  if (!frame.extended && !frame.error && frame.id > kMaxStandardId) return false;
  std::copy_n(wire.begin() + 8, frame.length, frame.data.begin());
  return true;
}

}  // namespace gannet::hal
