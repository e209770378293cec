#include "hal/gpio/line_kinds.hpp"

#include <utility>

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

struct Kind {
  const char* name;
  Input (*input)(const LineConfig&);
  Output (*output)(const LineConfig&);
};
constexpr Kind kKinds[] = {
    {"simulated",
     [](const LineConfig& c) -> Input { return std::make_unique<SimulatedInput>(c.path, c.name); },
     [](const LineConfig& c) -> Output {
       return std::make_unique<SimulatedOutput>(c.path, c.name);
     }},
};

Result<const Kind*> find(const LineConfig& config) {
  std::string known = "none";
  for (const Kind& kind : kKinds) {
    known += std::string(", ") + kind.name;
    if (config.kind != kind.name) continue;
    if (config.path.empty() || config.name.empty()) {
      return Error{"a line of kind '" + config.kind + "' needs a path and a name"};
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
  Input line = (*kind)->input(config);
  if (config.active_low) line = std::make_unique<ActiveLowInput>(std::move(line));
  return line;
}

Result<Output> make_output(const LineConfig& config) {
  if (config.kind == "none") return Output(std::make_unique<AbsentOutput>());
  const auto kind = find(config);
  if (!kind) return kind.error();
  Output line = (*kind)->output(config);
  if (config.active_low) line = std::make_unique<ActiveLowOutput>(std::move(line));
  return line;
}

}  // namespace gannet::hal
