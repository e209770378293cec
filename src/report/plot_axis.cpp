#include "src/report/plot_axis.hpp"

#include <algorithm>
#include <cmath>

#include "src/report/table.hpp"

namespace gannet::report {
namespace {

Range usable(Range r) {
  if (!std::isfinite(r.low) || !std::isfinite(r.high) || r.low > r.high) return {0, 1};
  // Equal, or so near that doubles cannot count in between.
  const double least = 1e-9 * std::max(std::abs(r.low), std::abs(r.high));
  if (r.high - r.low > least) return r;
  const double margin = r.low == 0 ? 1 : 0.1 * std::abs(r.low);
  return {r.low - margin, r.high + margin};
}

}  // namespace

double round_step(double rough) {
  const double power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

PlotAxis::PlotAxis(Range values, double from, double to, int wanted_ticks, bool nice)
    : range_(usable(values)), from_(from), to_(to) {
  const double step = round_step((range_.high - range_.low) / std::max(wanted_ticks, 1));
  decimals_ = std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 9);
  constexpr double kSlack = 1e-6;  // of a step, so that rounding hides no tick on the border
  if (nice) {
    range_.low = step * std::floor(range_.low / step + kSlack);
    range_.high = step * std::ceil(range_.high / step - kSlack);
  }
  const double first = std::ceil(range_.low / step - kSlack);
  const double last = std::floor(range_.high / step + kSlack);
  for (double k = first; k <= last; ++k) ticks_.push_back(k * step);
}

std::string PlotAxis::label(double tick) const {
  const std::string text = number(tick, decimals_);
  return text[0] == '-' ? "−" + text.substr(1) : text;
}

}  // namespace gannet::report
