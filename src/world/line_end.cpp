#include "src/world/line_end.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <string_view>
#include <utility>

#include "hal/gpio/simulated_line.hpp"
#include "platform/linux/fd.hpp"

namespace gannet::world {
namespace {

using hal::Level;

constexpr std::size_t index_of(WorldLine line) { return static_cast<std::size_t>(line); }

class SimulatedLineEnd final : public LineEnd {
 public:
  static Result<std::unique_ptr<LineEnd>> create(const LineEndConfig& config) {
    auto lines =
        hal::SimulatedLines::create(config.place, {kWorldLines.begin(), kWorldLines.end()});
    if (!lines) return lines.error();
    return std::unique_ptr<LineEnd>(new SimulatedLineEnd(config.place, std::move(*lines)));
  }

  void press(Button button, TimePoint now) override {
    const bool pressed = button == Button::kPressed;
    const Level first = pressed ? Level::kHigh : Level::kLow;
    write(WorldLine::kEstop, button == Button::kCut ? Level::kUnknown : first, now);
    write(WorldLine::kEstopSecond, pressed ? Level::kLow : Level::kHigh, now);
  }
  bool is_high(WorldLine line) override {
    return lines_.read(static_cast<int>(index_of(line))) == Level::kHigh;
  }
  hal::LineConfig config_of(WorldLine line) const override {
    hal::LineConfig config;
    config.kind = "simulated";
    config.path = place_;
    config.name = kWorldLines[index_of(line)];
    return config;
  }

 private:
  SimulatedLineEnd(std::string place, hal::SimulatedLines lines)
      : place_(std::move(place)), lines_(std::move(lines)) {}
  void write(WorldLine line, Level level, TimePoint now) {
    lines_.write(static_cast<int>(index_of(line)), level, now);
  }
  const std::string place_;
  hal::SimulatedLines lines_;
};

// The chip's line N is folder/sim_gpioN: what is written into `pull` an input reads, what an output
// drives stands in `value`. Lines count in the order of WorldLine.
class GpioSimEnd final : public LineEnd {
 public:
  static Result<std::unique_ptr<LineEnd>> create(const LineEndConfig& config) {
    std::error_code error;
    // The daemon wants /dev/gpiochipN; the folder's real name says N.
    const auto folder = std::filesystem::canonical(config.place, error);
    if (error) return Error{config.place + ": " + error.message()};
    std::unique_ptr<GpioSimEnd> end(new GpioSimEnd("/dev/" + folder.filename().string()));
    for (std::size_t i = 0; i < kWorldLines.size(); ++i) {
      const bool is_input = i <= index_of(WorldLine::kEstopSecond);
      const std::string path =
          folder.string() + "/sim_gpio" + std::to_string(i) + (is_input ? "/pull" : "/value");
      end->files_[i] =
          linux_os::Fd(open(path.c_str(), (is_input ? O_WRONLY : O_RDONLY) | O_CLOEXEC));
      if (!end->files_[i].valid()) return linux_os::system_error(path, errno);
    }
    end->press(Button::kReleased, {});
    return std::unique_ptr<LineEnd>(std::move(end));
  }

  void press(Button button, TimePoint) override {
    pull(WorldLine::kEstop, button != Button::kReleased);
    pull(WorldLine::kEstopSecond, button != Button::kPressed);
  }
  bool is_high(WorldLine line) override {
    char value = '0';
    return pread(files_[index_of(line)].get(), &value, 1, 0) == 1 && value == '1';
  }
  hal::LineConfig config_of(WorldLine line) const override {
    hal::LineConfig config;
    config.kind = "gpiod";
    config.chip = chip_;
    config.line = std::to_string(index_of(line));
    config.bias = "as_is";  // a bias that is asked for would overwrite the pull
    return config;
  }

 private:
  explicit GpioSimEnd(std::string chip) : chip_(std::move(chip)) {}
  void pull(WorldLine line, bool up) {
    const std::string_view word = up ? "pull-up" : "pull-down";
    // A file of sysfs takes the whole word or nothing; a chip that is gone is the daemon's to
    // notice.
    [[maybe_unused]] const auto written =
        pwrite(files_[index_of(line)].get(), word.data(), word.size(), 0);
  }
  const std::string chip_;
  std::array<linux_os::Fd, kWorldLines.size()> files_;
};

}  // namespace

Result<std::unique_ptr<LineEnd>> make_line_end(const LineEndConfig& config) {
  if (config.kind == "gpio-sim") return GpioSimEnd::create(config);
  return SimulatedLineEnd::create(config);
}

void configure_lines(const LineEnd& end, const LineEndConfig& config, config::GpioConfig& gpio) {
  gpio.estop = end.config_of(WorldLine::kEstop);
  gpio.release = end.config_of(WorldLine::kRelease);
  gpio.light = end.config_of(WorldLine::kLight);
  if (!config.two_contacts) return;
  gpio.estop_second = end.config_of(WorldLine::kEstopSecond);
  gpio.estop_second.active_low = true;
}

}  // namespace gannet::world
