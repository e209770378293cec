#include "hal/gpio/line_kinds.hpp"

#include <utility>

#include "hal/gpio/gpiod_line.hpp"
#include "hal/gpio/simulated_line.hpp"

namespace gannet::hal {
namespace {

using Input = std::unique_ptr<DigitalInput>;
using Output = std::unique_ptr<DigitalOutput>;

class AbsentInput final : public DigitalInput {
 public:
  Reading read(TimePoint) override { return {.level = Level::kLow}; }
};

class AbsentOutput final : public DigitalOutput {
 public:
  bool write(bool, TimePoint) override { return true; }
};

class ActiveLowInput final : public DigitalInput {
 public:
  explicit ActiveLowInput(Input line) : line_(std::move(line)) {}
  Reading read(TimePoint now) override {
    Reading reading = line_->read(now);
    std::swap(reading.rose, reading.fell);
    if (reading.level == Level::kUnknown) return reading;
    reading.level = reading.level == Level::kLow ? Level::kHigh : Level::kLow;
    return reading;
  }

 private:
  Input line_;
};

class ActiveLowOutput final : public DigitalOutput {
 public:
  explicit ActiveLowOutput(Output line) : line_(std::move(line)) {}
  bool write(bool high, TimePoint now) override { return line_->write(!high, now); }

 private:
  Output line_;
};

// Leaves the line inactive when the program lets go of it.
class RestingOutput final : public DigitalOutput {
 public:
  explicit RestingOutput(Output line) : line_(std::move(line)) {}
  ~RestingOutput() override { line_->write(false, newest_); }
  bool write(bool high, TimePoint now) override {
    newest_ = now;
    return line_->write(high, now);
  }

 private:
  Output line_;
  TimePoint newest_ = {};
};

template <class Line, class Made>
Result<Line> as_line(Result<Made> made) {
  if (!made) return made.error();
  return Line(std::move(*made));
}

struct Kind {
  const char* name;
  std::string LineConfig::*place;  // both of these are needed
  std::string LineConfig::*line;
  Result<Input> (*input)(const LineConfig&);
  Result<Output> (*output)(const LineConfig&);
};
constexpr Kind kKinds[] = {
    {"gpiod", &LineConfig::chip, &LineConfig::line,
     [](const LineConfig& c) { return as_line<Input>(GpiodInput::open(c)); },
     [](const LineConfig& c) { return as_line<Output>(GpiodOutput::open(c, c.active_low)); }},
    {"simulated", &LineConfig::path, &LineConfig::name,
     [](const LineConfig& c) {
       return Result<Input>(std::make_unique<SimulatedInput>(c.path, c.name));
     },
     [](const LineConfig& c) {
       return Result<Output>(std::make_unique<SimulatedOutput>(c.path, c.name));
     }},
};

Result<const Kind*> find(const LineConfig& config) {
  std::string known = "none";
  for (const Kind& kind : kKinds) {
    known += std::string(", ") + kind.name;
    if (config.kind != kind.name) continue;
    if ((config.*kind.place).empty() || (config.*kind.line).empty()) {
      return Error{"a line of kind '" + config.kind + "' needs " +
                   (config.kind == "gpiod" ? "a chip and a line" : "a path and a name")};
    }
    return &kind;
  }
  return Error{"line kind '" + config.kind + "' is unknown; there are " + known};
}

}  // namespace

Result<Input> make_input(const LineConfig& config) {
  if (config.kind == "none") return Input(std::make_unique<AbsentInput>());
  const auto kind = find(config);
  if (!kind) return kind.error();
  auto line = (*kind)->input(config);
  if (line && config.active_low) return Input(new ActiveLowInput(std::move(*line)));
  return line;
}

Result<Output> make_output(const LineConfig& config) {
  if (config.kind == "none") return Output(std::make_unique<AbsentOutput>());
  const auto kind = find(config);
  if (!kind) return kind.error();
  auto made = (*kind)->output(config);
  if (!made) return made.error();
  Output line = std::move(*made);
  if (config.active_low) line = std::make_unique<ActiveLowOutput>(std::move(line));
  return Output(new RestingOutput(std::move(line)));
}

}  // namespace gannet::hal
