#include "hal/camera/v4l2_controls.hpp"

#include <cctype>
#include <charconv>
#include <cstring>

#include "platform/base/nearest_word.hpp"

namespace gannet::hal {
namespace {

constexpr int kMostControls = 512;  // a driver that enumerates without end
constexpr int kMostEntries = 256;

template <std::size_t N>
std::string words_of(const __u8 (&text)[N]) {
  const auto* letters = reinterpret_cast<const char*>(text);
  return {letters, strnlen(letters, N)};
}

bool is_simple(std::uint32_t type) {
  return type == V4L2_CTRL_TYPE_INTEGER || type == V4L2_CTRL_TYPE_BOOLEAN ||
         type == V4L2_CTRL_TYPE_MENU || type == V4L2_CTRL_TYPE_INTEGER_MENU ||
         type == V4L2_CTRL_TYPE_BITMASK || type == V4L2_CTRL_TYPE_BUTTON;
}

bool is_menu(const V4l2Control& c) {
  return c.type == V4L2_CTRL_TYPE_MENU || c.type == V4L2_CTRL_TYPE_INTEGER_MENU;
}

std::optional<int> read_value(V4l2System& system, int fd, const V4l2Control& c) {
  if (c.type == V4L2_CTRL_TYPE_BUTTON || (c.flags & V4L2_CTRL_FLAG_WRITE_ONLY) != 0)
    return std::nullopt;
  v4l2_control control = {c.id, 0};
  if (system.ioctl(fd, VIDIOC_G_CTRL, &control) != 0) return std::nullopt;
  return control.value;
}

void read_menu(V4l2System& system, int fd, V4l2Control& c) {
  for (int i = c.min, entries = 0; i <= c.max && entries < kMostEntries; ++i, ++entries) {
    v4l2_querymenu entry = {};
    entry.id = c.id;
    entry.index = static_cast<std::uint32_t>(i);
    if (system.ioctl(fd, VIDIOC_QUERYMENU, &entry) != 0) continue;  // menus may have holes
    c.menu.emplace_back(
        i, c.type == V4L2_CTRL_TYPE_MENU ? words_of(entry.name) : std::to_string(entry.value));
  }
}

Error refuse(const std::string& device, const std::string& what) {
  return Error{device + ": control " + what};
}

// The number that a person's word means to this control.
std::optional<int> number_of(const V4l2Control& c, const std::string& word) {
  int number = 0;
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (problem == std::errc() && end == word.data() + word.size()) return number;
  if (c.type == V4L2_CTRL_TYPE_BOOLEAN && (word == "true" || word == "false"))
    return word == "true" ? 1 : 0;
  for (const auto& [index, name] : c.menu)
    if (control_name(name) == control_name(word)) return index;
  return std::nullopt;
}

bool fits(const V4l2Control& c, int number) {
  if (is_menu(c)) {
    for (const auto& entry : c.menu)
      if (entry.first == number) return true;
    return false;
  }
  if (c.type == V4L2_CTRL_TYPE_BITMASK || c.type == V4L2_CTRL_TYPE_BUTTON) return true;
  return number >= c.min && number <= c.max;
}

const V4l2Control* find(const std::vector<V4l2Control>& controls, const std::string& name) {
  for (const V4l2Control& c : controls)
    if (c.name == name) return &c;
  return nullptr;
}

struct Setting {
  const V4l2Control* control;
  int number;
  std::string text;
};

Result<Setting> read_setting(const std::vector<V4l2Control>& controls, const std::string& device,
                             const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    return refuse(device, "\"" + text + "\" is not of the form name=value");
  const std::string name = text.substr(0, equals), word = text.substr(equals + 1);
  const V4l2Control* const c = find(controls, name);
  if (c == nullptr) {
    std::vector<std::string> known;
    std::string all;
    for (const V4l2Control& one : controls) {
      known.push_back(one.name);
      all += (all.empty() ? "; the device has " : ", ") + one.name;
    }
    return refuse(device, "'" + name + "' is not there" + did_you_mean(name, known) +
                              (all.empty() ? "; the device has none" : all));
  }
  const auto number = number_of(*c, word);
  if (!number || !fits(*c, *number))
    return refuse(device, "'" + name + "': '" + word + "' does not fit: " + text_of(*c));
  return Setting{c, *number, text};
}

}  // namespace

std::string control_name(const std::string& driver_words) {
  std::string name;
  bool gap = false;
  for (const char letter : driver_words) {
    const auto c = static_cast<unsigned char>(letter);
    if (std::isalnum(c) == 0) {
      gap = !name.empty();
      continue;
    }
    if (gap) name += '_';
    gap = false;
    name += static_cast<char>(std::tolower(c));
  }
  return name;
}

std::vector<V4l2Control> list_controls(V4l2System& system, int fd) {
  std::vector<V4l2Control> controls;
  std::uint32_t last = 0;
  for (int i = 0; i < kMostControls; ++i) {
    v4l2_queryctrl query = {};
    query.id = last | V4L2_CTRL_FLAG_NEXT_CTRL;
    if (system.ioctl(fd, VIDIOC_QUERYCTRL, &query) != 0 || query.id <= last) break;
    last = query.id;
    if (!is_simple(query.type) || (query.flags & V4L2_CTRL_FLAG_DISABLED) != 0) continue;
    V4l2Control c = {.id = query.id,
                     .type = query.type,
                     .flags = query.flags,
                     .name = control_name(words_of(query.name)),
                     .min = query.minimum,
                     .max = query.maximum,
                     .step = query.step,
                     .default_value = query.default_value,
                     .value = {},
                     .menu = {}};
    if (is_menu(c)) read_menu(system, fd, c);
    c.value = read_value(system, fd, c);
    controls.push_back(std::move(c));
  }
  return controls;
}

std::string text_of(const V4l2Control& c) {
  std::string text = c.name;
  if (c.type == V4L2_CTRL_TYPE_BUTTON) return text + " (button)";
  if (c.type == V4L2_CTRL_TYPE_BITMASK)
    return text + " (bits), now " + std::to_string(c.value.value_or(0));
  if (is_menu(c)) {
    for (const auto& [index, name] : c.menu)
      text += (index == c.menu.front().first ? " " : ", ") + std::to_string(index) + " " + name;
  } else if (c.type == V4L2_CTRL_TYPE_BOOLEAN) {
    text += " 0, 1";
  } else {
    text += " " + std::to_string(c.min) + " … " + std::to_string(c.max);
    if (c.step > 1) text += " by " + std::to_string(c.step);
  }
  text += " (" + std::to_string(c.default_value) + " by default)";
  if (c.value) text += ", now " + std::to_string(*c.value);
  if ((c.flags & V4L2_CTRL_FLAG_INACTIVE) != 0) text += ", inactive";
  if ((c.flags & V4L2_CTRL_FLAG_READ_ONLY) != 0) text += ", read only";
  return text;
}

Result<void> apply_controls(V4l2System& system, int fd, const std::string& device,
                            const std::vector<std::string>& wanted) {
  if (wanted.empty()) return {};
  const std::vector<V4l2Control> controls = list_controls(system, fd);
  std::vector<Setting> settings;
  for (const std::string& text : wanted) {
    const auto setting = read_setting(controls, device, text);
    if (!setting) return setting.error();
    v4l2_control control = {setting->control->id, setting->number};
    if (const int error = system.ioctl(fd, VIDIOC_S_CTRL, &control); error != 0)
      return refuse(device, "\"" + text + "\" was refused: " + std::strerror(-error) +
                                "; another control may have to be set before it");
    settings.push_back(*setting);
  }
  // Only now: a later one may have changed an earlier one.
  for (const Setting& setting : settings) {
    const auto value = read_value(system, fd, *setting.control);
    if (value && *value != setting.number)
      return refuse(device, "\"" + setting.text + "\" was not kept: the driver made " +
                                std::to_string(*value) + " of it; " + text_of(*setting.control));
  }
  return {};
}

bool moves_the_hue(const std::vector<V4l2Control>& controls) {
  for (const V4l2Control& c : controls)
    if (c.id == V4L2_CID_AUTO_WHITE_BALANCE && c.value.value_or(0) != 0) return true;
  return false;
}

}  // namespace gannet::hal
