#include "hal/gpio/gpiod_calls.hpp"

#include <cerrno>
#include <charconv>
#include <cstring>

namespace gannet::hal {

Error line_error(const LineRequest& request, const char* what, int error_number) {
  std::string text = "line '" + request.line + "' of GPIO chip '" + request.chip + "': " + what +
                     ": " + std::strerror(error_number);
  if (error_number == EACCES || error_number == EPERM) {
    text += "; may the user open the chip (see `ls -l /dev/gpiochip*`)?";
  } else if (error_number == EBUSY) {
    text += "; who has it, `gpioinfo` tells";
  } else if (error_number == ENOENT || error_number == ENODEV) {
    text += "; what there is, `gpiodetect` and `gpioinfo` tell";
  }
  return Error{text};
}

int offset_from(const std::string& text) {
  int offset = -1;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, offset);
  return result.ec == std::errc() && result.ptr == end && offset >= 0 ? offset : -1;
}

}  // namespace gannet::hal
