#include "tests/bench/measure.hpp"

#include <time.h>

#include <algorithm>
#include <cstddef>

namespace gannet::bench {
namespace {

double ns_of(clockid_t clock) {
  timespec t = {};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) * 1e9 + static_cast<double>(t.tv_nsec);
}

volatile double sink = 0;

}  // namespace

double thread_cpu_ns() { return ns_of(CLOCK_THREAD_CPUTIME_ID); }
double wall_ns() { return ns_of(CLOCK_MONOTONIC); }
void consume(double value) { sink = value; }

double quantile(std::vector<double> samples, double share) {
  if (samples.empty()) return 0;
  const auto at = static_cast<std::size_t>(share * static_cast<double>(samples.size() - 1) + 0.5);
  std::nth_element(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(at),
                   samples.end());
  return samples[at];
}

Spread spread_of(std::vector<double> samples) {
  return {quantile(samples, 0.5), quantile(samples, 0.25), quantile(samples, 0.75)};
}

std::vector<double> ratios_of(const std::vector<double>& above, const std::vector<double>& below) {
  std::vector<double> out;
  for (std::size_t i = 0; i < std::min(above.size(), below.size()); ++i) {
    if (below[i] > 0) out.push_back(above[i] / below[i]);
  }
  return out;
}

std::vector<std::vector<double>> interleave(const std::vector<Contender>& contenders, int turns,
                                            Caches caches) {
  std::vector<std::vector<double>> out(contenders.size());
  for (int turn = -1; turn < turns; ++turn) {
    for (std::size_t c = 0; c < contenders.size(); ++c) {
      // Each its own data in a turn: none may find what the one before has just loaded.
      const int data = std::max(turn, 0) + 3 * static_cast<int>(c);
      if (caches == Caches::kWarm) contenders[c].work(data);
      const double start = thread_cpu_ns();
      const double units = contenders[c].work(data);
      const double spent = thread_cpu_ns() - start;
      if (turn >= 0) out[c].push_back(spent / units);
    }
  }
  return out;
}

}  // namespace gannet::bench
