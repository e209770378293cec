#include "src/safety/estop_input.hpp"

namespace gannet::safety {

Line EstopInput::step(const Channel& first, const Channel& second, TimePoint now) {
  watch_discrepancy(first.line, second.line, now);
  const Line line = judge(first, second, now);
  if (line == Line::kActive && last_ == Line::kInactive) ++presses_;
  last_ = line;
  return line;
}

Line EstopInput::judge(const Channel& first, const Channel& second, TimePoint now) {
  const bool is_active = first.line == Line::kActive || second.line == Line::kActive ||
                         first.pressed || second.pressed;
  const bool is_unknown = first.line == Line::kUnknown || second.line == Line::kUnknown;
  if (is_active || is_unknown) held_ = true;
  if (is_active || is_unknown || first.released || second.released) stirred_ = now;
  if (is_active) return Line::kActive;
  if (is_unknown || distrusted_) return Line::kUnknown;
  if (held_ && now - stirred_ < release_) return Line::kActive;
  held_ = false;
  return Line::kInactive;
}

void EstopInput::watch_discrepancy(Line first, Line second, TimePoint now) {
  if (first == Line::kUnknown || second == Line::kUnknown) {
    disagree_ = false;  // that is another fault, and a stop by itself
    return;
  }
  if (first != second) {
    if (!disagree_) disagree_since_ = now;
    disagree_ = true;
    if (!distrusted_ && now - disagree_since_ > discrepancy_) {
      distrusted_ = true;
      both_pressed_ = false;
      ++discrepancies_;
    }
    return;
  }
  disagree_ = false;
  if (first == Line::kActive) both_pressed_ = true;
  if (first == Line::kInactive && both_pressed_) distrusted_ = false;
}

}  // namespace gannet::safety
