// CanFrame: one classic CAN 2.0 data frame, as SocketCAN has it. A value; RT safe.
#pragma once

#include <array>
#include <cstdint>

namespace gannet::hal {

struct CanFrame {
  std::uint32_t id = 0;     // 11 or 29 bits, without flags
  bool extended = false;    // 29-bit identifier
  bool error = false;       // an error frame of the controller, not a data frame
  std::uint8_t length = 0;  // 0 … 8
  std::array<std::uint8_t, 8> data = {};

  friend bool operator==(const CanFrame&, const CanFrame&) = default;
};

inline constexpr std::uint32_t kMaxStandardId = 0x7FF;
inline constexpr std::uint32_t kMaxExtendedId = 0x1FFFFFFF;

// A frame is wanted when its id equals id in all the bits of mask. Several filters are an or.
struct CanFilter {
  std::uint32_t id = 0;
  std::uint32_t mask = 0;
  bool extended = false;

  constexpr bool matches(const CanFrame& frame) const {
    return frame.extended == extended && !frame.error && ((frame.id ^ id) & mask) == 0;
  }
  friend bool operator==(const CanFilter&, const CanFilter&) = default;
};

}  // namespace gannet::hal
