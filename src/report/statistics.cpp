#include "src/report/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

namespace gannet::report {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double percentile_of_sorted(const std::vector<double>& sorted, double percent) {
  if (sorted.empty()) return kNaN;
  const double place =
      std::clamp(percent, 0.0, 100.0) / 100 * static_cast<double>(sorted.size() - 1);
  const std::size_t below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  const double share = place - static_cast<double>(below);
  return sorted[below] + share * (sorted[above] - sorted[below]);
}

std::vector<double> sorted_copy(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

// Probability of at most `events` where `mean_events` are expected.
double poisson_at_most(int events, double mean_events) {
  double sum = 0;
  for (int k = 0; k <= events; ++k)
    sum += std::exp(k * std::log(mean_events) - mean_events - std::lgamma(k + 1.0));
  return sum;
}

// The mean at which that probability is `share`; it falls as the mean grows.
double poisson_mean(int events, double share) {
  double low = 0, high = events + 12 * std::sqrt(events + 1.0);
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (poisson_at_most(events, middle) > share ? low : high) = middle;
  }
  return high;
}

// The 97.5 % quantile of Student's t: tabled for few degrees of freedom, beyond them the
// Cornish-Fisher series, which is right to four digits there.
double t_quantile(std::size_t freedom) {
  constexpr double kTable[] = {12.7062, 4.3027, 3.1824, 2.7764, 2.5706,
                               2.4469,  2.3646, 2.3060, 2.2622, 2.2281};
  if (freedom <= std::size(kTable)) return kTable[freedom - 1];
  constexpr double z = 1.959963984540054;
  const auto n = static_cast<double>(freedom);
  const double z3 = z * z * z, z5 = z3 * z * z;
  return z + (z3 + z) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z) / (96 * n * n);
}

}  // namespace

double mean(std::span<const double> values) {
  if (values.empty()) return kNaN;
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double rms(std::span<const double> values) {
  if (values.empty()) return kNaN;
  double sum = 0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double standard_deviation(std::span<const double> values) {
  if (values.empty()) return kNaN;
  if (values.size() == 1) return 0;
  const double centre = mean(values);
  double sum = 0;
  for (const double v : values) sum += (v - centre) * (v - centre);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

double percentile(std::span<const double> values, double percent) {
  return percentile_of_sorted(sorted_copy(values), percent);
}

Summary summarise(std::span<const double> values) {
  const std::vector<double> sorted = sorted_copy(values);
  return {.count = static_cast<int>(values.size()),
          .mean = mean(values),
          .rms = rms(values),
          .deviation = standard_deviation(values),
          .min = percentile_of_sorted(sorted, 0),
          .p50 = percentile_of_sorted(sorted, 50),
          .p90 = percentile_of_sorted(sorted, 90),
          .p99 = percentile_of_sorted(sorted, 99),
          .max = percentile_of_sorted(sorted, 100)};
}

Interval wilson95(int successes, int trials) {
  if (trials <= 0) return {};
  constexpr double kZ = 1.959963984540054;  // 97.5 % of the normal distribution
  const double n = trials;
  const double p = successes / n;
  const double centre = p + kZ * kZ / (2 * n);
  const double half = kZ * std::sqrt(p * (1 - p) / n + kZ * kZ / (4 * n * n));
  const double scale = 1 + kZ * kZ / n;
  return {successes == 0 ? 0 : (centre - half) / scale,
          successes == trials ? 1 : (centre + half) / scale};
}

Interval poisson95(int events) {
  return {events == 0 ? 0 : poisson_mean(events - 1, 0.975), poisson_mean(events, 0.025)};
}

MeanInterval mean95(std::span<const double> values) {
  if (values.size() < 2) return {kNaN, kNaN};
  const double half = t_quantile(values.size() - 1) * standard_deviation(values) /
                      std::sqrt(static_cast<double>(values.size()));
  return {mean(values) - half, mean(values) + half};
}

}  // namespace gannet::report
