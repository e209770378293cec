// LineEnd: the world's end of the daemon's digital lines: the e-stop button with one contact or two
// (the second moves the other way), and what the daemon puts out. Kinds: simulated (a mapped file),
// gpio-sim (lines of the kernel's simulated chip, driven through its files in sysfs). World's
// thread alone.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hal/gpio/digital_line.hpp"
#include "platform/base/result.hpp"
#include "platform/base/time.hpp"
#include "src/config/daemon_config.hpp"

namespace gannet::world {

enum class WorldLine : std::uint8_t { kEstop, kEstopSecond, kRelease, kLight };
inline constexpr std::array<const char*, 4> kWorldLines = {"estop", "estop_second", "release",
                                                           "light"};

enum class Button : std::uint8_t { kReleased, kPressed, kCut };

struct LineEndConfig {
  std::string kind = "simulated";  // simulated | gpio-sim
  std::string place;               // the mapped file, or the chip's folder in sysfs
  bool two_contacts = false;
};

class LineEnd {
 public:
  virtual ~LineEnd() = default;

  // kCut: a wire of the first contact is broken. Where the kind can say so the line cannot be read;
  // a line of a chip is pulled up then, which is pressed.
  virtual void press(Button button, TimePoint now) = 0;
  virtual bool is_high(WorldLine line) = 0;  // of an output
  virtual hal::LineConfig config_of(WorldLine line) const = 0;
};

// Error: no such place, a line that the chip does not have.
Result<std::unique_ptr<LineEnd>> make_line_end(const LineEndConfig& config);

// What the daemon is told of these lines.
void configure_lines(const LineEnd& end, const LineEndConfig& config, config::GpioConfig& gpio);

}  // namespace gannet::world
