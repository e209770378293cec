// Lines of the kernel's GPIO chips, kind "gpiod". An input's level and edges are both read every
// cycle: the level, so that no lost edge can hide a press; the edges, so that no press between two
// cycles is missed. A line whose reading fails, as when its chip was unplugged, is kUnknown from
// then on. An output has the given level from its very first moment. After the program the level
// is the driver's business: an external pull decides (docs/guides/can-and-gpio.md).
// Created at start-up; then one thread, RT safe.
#pragma once

#include <memory>

#include "hal/gpio/digital_line.hpp"
#include "hal/gpio/gpiod_calls.hpp"
#include "hal/gpio/line_config.hpp"
#include "platform/base/result.hpp"

namespace gannet::hal {

class GpiodInput final : public DigitalInput {
 public:
  // Error: which chip or line, why and what to do.
  static Result<std::unique_ptr<GpiodInput>> open(const LineConfig& config,
                                                  GpioCalls& calls = linux_gpio_calls());
  Reading read(TimePoint now) override;  // electrical levels; config.active_low is not looked at

 private:
  explicit GpiodInput(std::unique_ptr<HeldLine> line) : line_(std::move(line)) {}
  std::unique_ptr<HeldLine> line_;
};

class GpiodOutput final : public DigitalOutput {
 public:
  // high: the level that it begins with.
  static Result<std::unique_ptr<GpiodOutput>> open(const LineConfig& config, bool high,
                                                   GpioCalls& calls = linux_gpio_calls());
  bool write(bool high, TimePoint now) override;

 private:
  explicit GpiodOutput(std::unique_ptr<HeldLine> line) : line_(std::move(line)) {}
  std::unique_ptr<HeldLine> line_;
};

}  // namespace gannet::hal
