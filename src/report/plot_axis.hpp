// PlotAxis: from values to pixels along one axis, with ticks at round numbers (1, 2 or 5 times a
// power of ten). Any thread; a value.
#pragma once

#include <string>
#include <vector>

namespace gannet::report {

struct Range {
  double low = 0;
  double high = 1;
};

class PlotAxis {
 public:
  // Values range (widened where it is empty or not finite) onto pixels from … to (to < from: up).
  // nice: the range is widened to whole ticks.
  PlotAxis(Range values, double from, double to, int wanted_ticks, bool nice);

  double pixel(double value) const {
    return from_ + (value - range_.low) / (range_.high - range_.low) * (to_ - from_);
  }
  const Range& range() const { return range_; }
  const std::vector<double>& ticks() const { return ticks_; }
  std::string label(double tick) const;  // with just the decimals that the step needs

 private:
  Range range_;
  double from_;
  double to_;
  int decimals_ = 0;
  std::vector<double> ticks_;
};

// The least 1, 2 or 5 · 10^k that is at least rough (> 0).
double round_step(double rough);

}  // namespace gannet::report
