// The 16 bytes in which Linux passes a classic CAN frame to and from a socket (struct can_frame of
// linux/can.h), for every kind that speaks them. A test compares with the kernel's header.
// Values; RT safe.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "hal/can/can_frame.hpp"

namespace gannet::hal {

inline constexpr int kCanWireBytes = 16;
using CanWire = std::array<std::uint8_t, kCanWireBytes>;

CanWire to_wire(const CanFrame& frame);

// False for what is no classic data or error frame: another size, a remote frame, a length above
// 8, an 11-bit id with more than 11 bits.
bool from_wire(std::span<const std::uint8_t> wire, CanFrame& frame);

}  // namespace gannet::hal
