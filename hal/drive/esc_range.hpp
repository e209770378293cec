// EscRange: which raw commands an ESC understands as stop, full forward and full reverse; both
// ways, for the drive and for the simulated node. Values; RT safe.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

namespace gannet::hal {

struct EscRange {
  std::int16_t stop = 0;
  std::int16_t forward = 8191;
  std::int16_t reverse = -8191;  // equal to stop: it cannot reverse
};

// Empty: unknown name. The names are explained in drive_config.cpp.
constexpr std::optional<EscRange> esc_range(std::string_view name) {
  if (name == "reversible") return EscRange{0, 8191, -8191};
  if (name == "forward_only") return EscRange{0, 8191, 0};
  if (name == "pwm_centred") return EscRange{4096, 8191, 1};  // equal steps to both sides
  return {};
}

// fraction −1 … 1, clamped; NaN stops.
inline std::int16_t command_of(const EscRange& range, double fraction) {
  if (std::isnan(fraction)) return range.stop;
  const double end = fraction < 0 ? range.reverse : range.forward;
  const double part = std::fmin(std::fabs(fraction), 1.0);
  return static_cast<std::int16_t>(std::lround(range.stop + part * (end - range.stop)));
}

inline double fraction_of(const EscRange& range, int command) {
  const bool is_forward = (command - range.stop) * (range.forward - range.stop) > 0;
  if (is_forward) {
    const double part = static_cast<double>(command - range.stop) / (range.forward - range.stop);
    return std::fmin(part, 1.0);
  }
  if (range.reverse == range.stop) return 0;
  const double part = static_cast<double>(command - range.stop) / (range.reverse - range.stop);
  return 0.0 - std::fmin(std::fmax(part, 0.0), 1.0);  // 0, not −0, at stop
}

}  // namespace gannet::hal
