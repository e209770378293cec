// A V4L2 device's controls: listed, and set by name from the config. Names are those that v4l2-ctl
// prints: the driver's words in small letters, joined by underscores ("white_balance_automatic").
// Start-up only, and the thread that opens a device anew.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hal/camera/v4l2_system.hpp"
#include "platform/base/result.hpp"

namespace gannet::hal {

struct V4l2Control {
  std::uint32_t id = 0;
  std::uint32_t type = 0;  // V4L2_CTRL_TYPE_…
  std::uint32_t flags = 0;
  std::string name;
  int min = 0, max = 0, step = 0, default_value = 0;
  std::optional<int> value;  // none: it cannot be read
  std::vector<std::pair<int, std::string>> menu;
};

std::string control_name(const std::string& driver_words);

// Integers, booleans, menus, bit masks and buttons; strings and compound ones are left out.
std::vector<V4l2Control> list_controls(V4l2System& system, int fd);

// "brightness 0 … 255 (128 by default), now 130"
std::string text_of(const V4l2Control& control);

// Sets each "name=value" in this order; value is a number, true or false, or a menu entry's name.
// When all are set each is read back. Error: no such control (with those that there are), a value
// that does not fit or is refused, or another value read back.
Result<void> apply_controls(V4l2System& system, int fd, const std::string& device,
                            const std::vector<std::string>& wanted);

// Whether the driver shifts colours by itself: its automatic white balance is on.
bool moves_the_hue(const std::vector<V4l2Control>& controls);

}  // namespace gannet::hal
