// libFuzzer entry: CAN frames and log lines from any text. What is read can be written, and reads
// the same again.
#include <cstdlib>
#include <string_view>

#include "hal/can/can_text.hpp"

using namespace gannet::hal;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto frame = can_frame_from_text(text)) {
    const auto again = can_frame_from_text(to_text(*frame));
    if (!again || !(*again == *frame)) std::abort();
  }
  if (const auto line = can_log_line_from_text(text)) {
    const auto again = can_log_line_from_text(to_text(*line));
    if (!again || !(again->frame == line->frame) || again->time_us != line->time_us) std::abort();
  }
  return 0;
}
