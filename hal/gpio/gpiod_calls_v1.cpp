// By libgpiod 1.6. Levels and edges are one ioctl and one read each, their data on the stack.
#include <fcntl.h>
#include <gpiod.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "hal/gpio/gpiod_calls.hpp"

namespace gannet::hal {
namespace {

constexpr const char* kConsumer = "gannetd";

struct CloseChip {
  void operator()(gpiod_chip* chip) const { gpiod_chip_close(chip); }  // releases its lines
};
using Chip = std::unique_ptr<gpiod_chip, CloseChip>;

class LineV1 final : public HeldLine {
 public:
  LineV1(Chip chip, gpiod_line* line) : chip_(std::move(chip)), line_(line) {}

  int level() override {
    const int value = gpiod_line_get_value(line_);
    return value < 0 ? -errno : value;
  }
  int set_level(bool high) override {
    return gpiod_line_set_value(line_, high ? 1 : 0) < 0 ? -errno : 0;
  }
  int read_edges(std::span<LineEdge> edges) override {
    std::array<gpiod_line_event, 16> events;
    const auto room = static_cast<unsigned>(std::min(edges.size(), events.size()));
    const int fd = gpiod_line_event_get_fd(line_);
    const int n = gpiod_line_event_read_fd_multiple(fd, events.data(), room);
    if (n < 0) return errno == EAGAIN ? 0 : -errno;
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
      const timespec& t = events[i].ts;
      edges[i] = {events[i].event_type == GPIOD_LINE_EVENT_RISING_EDGE,
                  time_from_ns(t.tv_sec * std::int64_t{1'000'000'000} + t.tv_nsec)};
    }
    return n;
  }

 private:
  Chip chip_;
  gpiod_line* line_;
};

int flags_of(Bias bias) {
  switch (bias) {
    case Bias::kAsIs:
      return 0;
    case Bias::kPullUp:
      return GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP;
    case Bias::kPullDown:
      return GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
  }
  return 0;
}

gpiod_line* find_line(gpiod_chip* chip, const std::string& name) {
  if (gpiod_line* line = gpiod_chip_find_line(chip, name.c_str())) return line;
  const int offset = offset_from(name);
  if (offset >= 0) return gpiod_chip_get_line(chip, static_cast<unsigned>(offset));
  errno = ENOENT;
  return nullptr;
}

int hold_input(gpiod_line* line, int flags) {
  if (gpiod_line_request_both_edges_events_flags(line, kConsumer, flags) < 0) return -errno;
  const int fd = gpiod_line_event_get_fd(line);
  return fcntl(fd, F_SETFL, fcntl(fd, F_GETFL) | O_NONBLOCK) < 0 ? -errno : 0;
}

class CallsV1 final : public GpioCalls {
 public:
  Result<std::unique_ptr<HeldLine>> hold(const LineRequest& request) override {
    Chip chip(gpiod_chip_open_lookup(request.chip.c_str()));
    if (chip == nullptr) return line_error(request, "opening the chip", errno);
    gpiod_line* line = find_line(chip.get(), request.line);
    if (line == nullptr) return line_error(request, "finding the line", errno);
    const int flags = flags_of(request.bias);
    const int held =
        !request.is_output ? hold_input(line, flags)
        : gpiod_line_request_output_flags(line, kConsumer, flags, request.high ? 1 : 0) < 0 ? -errno
                                                                                            : 0;
    if (held < 0) return line_error(request, "taking the line", -held);
    return std::unique_ptr<HeldLine>(new LineV1(std::move(chip), line));
  }
};

}  // namespace

GpioCalls& linux_gpio_calls() {
  static CallsV1 calls;
  return calls;
}

}  // namespace gannet::hal
