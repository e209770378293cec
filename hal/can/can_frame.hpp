// CanFrame: one classic CAN 2.0 data frame, as SocketCAN has it. A value; RT safe.
#pragma once

#include <array>
#include <cstdint>

namespace gannet::hal {

struct CanFrame {
  std::uint32_t id = 0;       // 11 or 29 bits, without flags
  bool extended = false;      // 29-bit identifier
  bool error = false;         // an error frame of the controller, not a data frame
  std::uint8_t length = 0;    // 0 … 8
  std::array<std::uint8_t, 8> data = {};

  friend bool operator==(const CanFrame&, const CanFrame&) = default;
};

}  // namespace gannet::hal
