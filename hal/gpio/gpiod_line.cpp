#include "hal/gpio/gpiod_line.hpp"

#include <array>

namespace gannet::hal {
namespace {

LineRequest request_of(const LineConfig& config) {
  LineRequest request;
  request.chip = config.chip;
  request.line = config.line;
  request.bias = config.bias == "pull_up"     ? Bias::kPullUp
                 : config.bias == "pull_down" ? Bias::kPullDown
                                              : Bias::kAsIs;
  return request;
}

}  // namespace

Result<std::unique_ptr<GpiodInput>> GpiodInput::open(const LineConfig& config, GpioCalls& calls) {
  auto line = calls.hold(request_of(config));
  if (!line) return line.error();
  return std::unique_ptr<GpiodInput>(new GpiodInput(std::move(*line)));
}

DigitalInput::Reading GpiodInput::read(TimePoint) {
  Reading reading;
  const int level = line_->level();
  if (level < 0) return {};
  reading.level = level == 0 ? Level::kLow : Level::kHigh;
  std::array<LineEdge, 16> edges;  // as many as the kernel keeps
  int n = 0;
  int rounds = 0;  // bounded: a line that flutters must not hold the loop
  do {
    n = line_->read_edges(edges);
    if (n < 0) return {};
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
      (edges[i].is_rising ? reading.rose : reading.fell) = true;
      reading.edge_time = edges[i].time;
    }
  } while (n == static_cast<int>(edges.size()) && ++rounds < 4);
  return reading;
}

Result<std::unique_ptr<GpiodOutput>> GpiodOutput::open(const LineConfig& config, bool high,
                                                       GpioCalls& calls) {
  LineRequest request = request_of(config);
  request.is_output = true;
  request.high = high;
  auto line = calls.hold(request);
  if (!line) return line.error();
  return std::unique_ptr<GpiodOutput>(new GpiodOutput(std::move(*line)));
}

bool GpiodOutput::write(bool high, TimePoint) { return line_->set_level(high) == 0; }

}  // namespace gannet::hal
