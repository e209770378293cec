// By libgpiod 2. Levels and edges are one ioctl and one read each, into a buffer made beforehand.
#include <dirent.h>
#include <fcntl.h>
#include <gpiod.h>

#include <algorithm>
#include <cerrno>

#include "hal/gpio/gpiod_calls.hpp"

namespace gannet::hal {
namespace {

constexpr std::size_t kEdges = 16;

template <auto free>
struct Free {
  template <class T>
  void operator()(T* object) const {
    free(object);
  }
};
using Chip = std::unique_ptr<gpiod_chip, Free<gpiod_chip_close>>;
using ChipInfo = std::unique_ptr<gpiod_chip_info, Free<gpiod_chip_info_free>>;
using Settings = std::unique_ptr<gpiod_line_settings, Free<gpiod_line_settings_free>>;
using LineSetup = std::unique_ptr<gpiod_line_config, Free<gpiod_line_config_free>>;
using Setup = std::unique_ptr<gpiod_request_config, Free<gpiod_request_config_free>>;
using Held = std::unique_ptr<gpiod_line_request, Free<gpiod_line_request_release>>;
using Buffer = std::unique_ptr<gpiod_edge_event_buffer, Free<gpiod_edge_event_buffer_free>>;

class LineV2 final : public HeldLine {
 public:
  LineV2(Held held, Buffer buffer, unsigned offset)
      : held_(std::move(held)), buffer_(std::move(buffer)), offset_(offset) {}

  int level() override {
    const gpiod_line_value value = gpiod_line_request_get_value(held_.get(), offset_);
    if (value == GPIOD_LINE_VALUE_ERROR) return -errno;
    return value == GPIOD_LINE_VALUE_ACTIVE ? 1 : 0;
  }
  int set_level(bool high) override {
    const gpiod_line_value value = high ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
    return gpiod_line_request_set_value(held_.get(), offset_, value) < 0 ? -errno : 0;
  }
  int read_edges(std::span<LineEdge> edges) override {
    const std::size_t room = std::min(edges.size(), kEdges);
    const int n = gpiod_line_request_read_edge_events(held_.get(), buffer_.get(), room);
    if (n < 0) return errno == EAGAIN ? 0 : -errno;
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
      gpiod_edge_event* event = gpiod_edge_event_buffer_get_event(buffer_.get(), i);
      edges[i] = {
          gpiod_edge_event_get_event_type(event) == GPIOD_EDGE_EVENT_RISING_EDGE,
          time_from_ns(static_cast<std::int64_t>(gpiod_edge_event_get_timestamp_ns(event)))};
    }
    return n;
  }

 private:
  Held held_;
  Buffer buffer_;
  unsigned offset_;
};

bool has_label(gpiod_chip* chip, const std::string& label) {
  const ChipInfo info(gpiod_chip_get_info(chip));
  return info != nullptr && label == gpiod_chip_info_get_label(info.get());
}

// errno is set if there is none.
Chip open_chip(const std::string& name) {
  if (name.find('/') != std::string::npos) return Chip(gpiod_chip_open(name.c_str()));
  if (gpiod_is_gpiochip_device(("/dev/" + name).c_str())) {
    return Chip(gpiod_chip_open(("/dev/" + name).c_str()));
  }
  DIR* folder = opendir("/dev");
  Chip found;
  int error = ENOENT;
  for (dirent* entry = nullptr; !found && folder && (entry = readdir(folder)) != nullptr;) {
    const std::string path = std::string("/dev/") + entry->d_name;
    if (path.rfind("/dev/gpiochip", 0) != 0 || !gpiod_is_gpiochip_device(path.c_str())) continue;
    Chip chip(gpiod_chip_open(path.c_str()));
    if (!chip) {
      error = errno;
    } else if (has_label(chip.get(), name)) {
      found = std::move(chip);
    }
  }
  if (folder != nullptr) closedir(folder);
  errno = error;
  return found;
}

// −1, and errno, if there is none.
int find_line(gpiod_chip* chip, const std::string& name) {
  const int offset = gpiod_chip_get_line_offset_from_name(chip, name.c_str());
  if (offset >= 0) return offset;
  if (offset_from(name) < 0) errno = ENOENT;
  return offset_from(name);
}

gpiod_line_bias bias_of(Bias bias) {
  switch (bias) {
    case Bias::kAsIs:
      return GPIOD_LINE_BIAS_AS_IS;
    case Bias::kPullUp:
      return GPIOD_LINE_BIAS_PULL_UP;
    case Bias::kPullDown:
      return GPIOD_LINE_BIAS_PULL_DOWN;
  }
  return GPIOD_LINE_BIAS_AS_IS;
}

// Null, and errno, if the kernel refuses.
Held take_line(gpiod_chip* chip, const LineRequest& request, unsigned offset) {
  const Settings settings(gpiod_line_settings_new());
  const LineSetup lines(gpiod_line_config_new());
  const Setup setup(gpiod_request_config_new());
  if (!settings || !lines || !setup) return nullptr;
  gpiod_line_settings* s = settings.get();
  int refused = gpiod_line_settings_set_bias(s, bias_of(request.bias));
  if (request.is_output) {
    refused |= gpiod_line_settings_set_direction(s, GPIOD_LINE_DIRECTION_OUTPUT);
    refused |= gpiod_line_settings_set_output_value(
        s, request.high ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE);
  } else {
    refused |= gpiod_line_settings_set_direction(s, GPIOD_LINE_DIRECTION_INPUT);
    refused |= gpiod_line_settings_set_edge_detection(s, GPIOD_LINE_EDGE_BOTH);
    refused |= gpiod_line_settings_set_event_clock(s, GPIOD_LINE_CLOCK_MONOTONIC);
  }
  refused |= gpiod_line_config_add_line_settings(lines.get(), &offset, 1, s);
  if (refused != 0) return nullptr;
  gpiod_request_config_set_consumer(setup.get(), "gannetd");
  return Held(gpiod_chip_request_lines(chip, setup.get(), lines.get()));
}

class CallsV2 final : public GpioCalls {
 public:
  Result<std::unique_ptr<HeldLine>> hold(const LineRequest& request) override {
    const Chip chip = open_chip(request.chip);
    if (!chip) return line_error(request, "opening the chip", errno);
    const int offset = find_line(chip.get(), request.line);
    if (offset < 0) return line_error(request, "finding the line", errno);
    Held held = take_line(chip.get(), request, static_cast<unsigned>(offset));
    Buffer buffer(gpiod_edge_event_buffer_new(kEdges));
    if (!held || !buffer) return line_error(request, "taking the line", errno);
    const int fd = gpiod_line_request_get_fd(held.get());
    if (fcntl(fd, F_SETFL, fcntl(fd, F_GETFL) | O_NONBLOCK) < 0) {
      return line_error(request, "O_NONBLOCK", errno);
    }
    return std::unique_ptr<HeldLine>(
        new LineV2(std::move(held), std::move(buffer), static_cast<unsigned>(offset)));
  }
};

}  // namespace

GpioCalls& linux_gpio_calls() {
  static CallsV2 calls;
  return calls;
}

}  // namespace gannet::hal
