// CAN frames as can-utils writes them, for tests and logs:
//   123#0F00                                 11-bit id (3 hex digits), 0 … 8 data bytes
//   1F334455#11.22.33                        29-bit id (8 hex digits); dots between bytes are read
//   20000004#0004000000000000                a controller's error frame (id bit 29 set)
//   (1700000000.123456) can0 123#0F00        a line of `candump -L`, wall-clock time
// Remote frames (123#R) and CAN FD frames (123##…) are refused: no part of the program uses them.
// Control thread, tools and tests.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "hal/can/can_frame.hpp"
#include "platform/base/result.hpp"

namespace gannet::hal {

std::string to_text(const CanFrame& frame);

// Error: what is wrong with which text.
Result<CanFrame> can_frame_from_text(std::string_view text);

struct CanLogLine {
  std::int64_t time_us = 0;  // wall clock, as the log has it
  std::string interface;     // can0, vcan1 …
  CanFrame frame;
};

std::string to_text(const CanLogLine& line);
Result<CanLogLine> can_log_line_from_text(std::string_view text);

}  // namespace gannet::hal
