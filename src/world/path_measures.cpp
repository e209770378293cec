#include "src/world/path_measures.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "src/world/motion.hpp"

namespace gannet::world {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr double kPi = 3.14159265358979323846;

template <class Visit>
void each_row(const Trace& trace, const Window& window, Visit visit) {
  for (const TraceRow& row : trace.rows)
    if (row.time_s >= window.from_s && row.time_s <= window.until_s) visit(row);
}

template <class Visit>
void each_heard(const Trace& trace, const Window& window, Visit visit) {
  std::uint64_t last = 0;
  each_row(trace, window, [&](const TraceRow& row) {
    if (row.heard.frame == 0 || row.heard.frame == last) return;
    last = row.heard.frame;
    visit(row);
  });
}

template <class Of>
double mean_of(const Trace& trace, const Window& window, Of of) {
  double sum = 0;
  int count = 0;
  each_row(trace, window, [&](const TraceRow& row) {
    sum += of(row);
    ++count;
  });
  return count > 0 ? sum / count : kNothing;
}

// In the reference hand, so that both paths are those of fixed axes.
Eigen::Vector3d placed(const Trace& trace, const TraceRow& row, const Eigen::Vector3d& in_hand) {
  return (trace.reference_from_world * row.vehicle * trace.body_from_hand)(in_hand);
}

// Amplitude and phase of a path at one frequency: a·cos + b·sin as a − ib.
class SineFit {
 public:
  explicit SineFit(double frequency_hz) : rate_(2 * kPi * frequency_hz) {}
  void add(double time_s, double value) {
    const Eigen::Vector3d basis(1, std::cos(rate_ * time_s), std::sin(rate_ * time_s));
    normal_ += basis * basis.transpose();
    right_ += value * basis;
  }
  std::complex<double> amplitude() const {
    const Eigen::Vector3d x = normal_.ldlt().solve(right_);
    return {x[1], -x[2]};
  }

 private:
  double rate_;
  Eigen::Matrix3d normal_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_ = Eigen::Vector3d::Zero();
};

// Fewer rows than these fit any sine.
constexpr int kLeastRows = 10;

double crossing_hz(const std::vector<double>& frequency_hz, const std::vector<double>& values,
                   double level) {
  if (frequency_hz.empty()) return kNothing;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) return kNothing;
    if (values[i] >= level) continue;
    if (i == 0) return frequency_hz[0];
    const double share = (values[i - 1] - level) / (values[i - 1] - values[i]);
    return frequency_hz[i - 1] * std::pow(frequency_hz[i] / frequency_hz[i - 1], share);
  }
  return frequency_hz.back();
}

}  // namespace

double mean_place_mm(const Trace& trace, const Window& window, int axis) {
  return mean_of(trace, window,
                 [axis](const TraceRow& row) { return 1000 * row.target.translation[axis]; });
}

double mean_absolute_error_mm(const Trace& trace, const Window& window, int axis) {
  return mean_of(trace, window,
                 [axis](const TraceRow& row) { return 1000 * std::abs(row.error_m[axis]); });
}

double visit_absolute_error_mm(const Trace& trace, const Window& window, int axis) {
  double sum = 0;
  int count = 0;
  each_row(trace, window, [&](const TraceRow& row) {
    if (!row.heard.arrived) return;
    sum += 1000 * std::abs(row.error_m[axis]);
    ++count;
  });
  return count > 0 ? sum / count : kNothing;
}

int visits_done(const Trace& trace, const Window& window) {
  int done = 0;
  each_row(trace, window,
           [&](const TraceRow& row) { done = std::max(done, row.heard.visits_done); });
  return done;
}

Reach distance_reach_mm(const Trace& trace, const Window& window) {
  Reach reach = {kNothing, kNothing};
  each_row(trace, window, [&](const TraceRow& row) {
    reach.least_mm = std::fmin(reach.least_mm, 1000 * row.target.translation.z());
    reach.most_mm = std::fmax(reach.most_mm, 1000 * row.target.translation.z());
  });
  return reach;
}

double fitness_kept(const Trace& trace, const Window& window) {
  constexpr std::size_t kFirst = 30;
  std::vector<double> first;
  each_heard(trace, {}, [&](const TraceRow& row) {
    if (row.heard.found && first.size() < kFirst) first.push_back(row.heard.fitness);
  });
  double least = kNothing;
  each_heard(trace, window, [&](const TraceRow& row) {
    if (row.heard.found) least = std::fmin(least, row.heard.fitness);
  });
  if (first.empty()) return kNothing;
  std::nth_element(first.begin(), first.begin() + static_cast<std::ptrdiff_t>(first.size() / 2),
                   first.end());
  return least / first[first.size() / 2];
}

std::complex<double> response_at(const Trace& trace, const Window& window, int axis,
                                 double frequency_hz) {
  SineFit target(frequency_hz), held(frequency_hz);
  int rows = 0;
  each_row(trace, window, [&](const TraceRow& row) {
    const Eigen::Vector3d there = row.target.translation;
    target.add(row.time_s, placed(trace, row, there)[axis]);
    held.add(row.time_s, placed(trace, row, there - row.error_m)[axis]);
    ++rows;
  });
  if (rows < kLeastRows || std::abs(target.amplitude()) < 1e-9) return {kNothing, kNothing};
  return held.amplitude() / target.amplitude();
}

double lag_deg(const Trace& trace, const Window& window, int axis, double frequency_hz) {
  return -std::arg(response_at(trace, window, axis, frequency_hz)) * 180 / kPi;
}

Bode bode(const Trace& trace, const Window& window, int axis) {
  Bode out;
  if (trace.rows.empty()) return out;
  const double length = std::min(window.until_s, trace.rows.back().time_s) - window.from_s;
  const double periods = std::floor(length / kMultisinePeriod_s + 1e-6);
  if (periods < 1) return out;
  // The row at the end would count the period's first moment twice.
  const Window whole = {window.from_s,
                        window.from_s + periods * kMultisinePeriod_s - 0.5 * trace.period_s};
  for (const double frequency_hz : multisine_hz(axis)) {
    const std::complex<double> response = response_at(trace, whole, axis, frequency_hz);
    double phase = std::arg(response) * 180 / kPi;
    if (!out.phase_deg.empty()) phase += 360 * std::round((out.phase_deg.back() - phase) / 360);
    out.frequency_hz.push_back(frequency_hz);
    out.gain.push_back(std::abs(response));
    out.phase_deg.push_back(phase);
  }
  return out;
}

double cutoff_hz(const Bode& bode) {
  return crossing_hz(bode.frequency_hz, bode.gain, std::sqrt(0.5));
}

double quarter_hz(const Bode& bode) { return crossing_hz(bode.frequency_hz, bode.phase_deg, -90); }

int frames_heard(const Trace& trace, const Window& window) {
  int count = 0;
  each_heard(trace, window, [&](const TraceRow&) { ++count; });
  return count;
}

}  // namespace gannet::world
