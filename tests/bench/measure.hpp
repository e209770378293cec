// Measuring side by side: contenders take turns, A B C A B C …, so that what disturbs the machine
// disturbs all of them; ratios are taken within a turn and then their median. Compute is measured
// in CPU time of the thread (other work does not count), hand-overs in wall time.
// Benchmarks only, one thread.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace gannet::bench {

double thread_cpu_ns();
double wall_ns();

// Keeps a result alive, so that the compiler does not leave out what made it.
void consume(double value);

struct Spread {
  double median = 0, low = 0, high = 0;  // low and high: the quartiles
};
Spread spread_of(std::vector<double> samples);
double quantile(std::vector<double> samples, double share);

// Ratio by ratio, turn by turn.
std::vector<double> ratios_of(const std::vector<double>& above, const std::vector<double>& below);

struct Contender {
  std::string name;
  // Does the work of one turn and returns how many units (points, pairs, …) that was. data: a
  // number that changes from turn to turn and from contender to contender; it chooses the data.
  std::function<double(int data)> work;
};

// kWarm: the same work once before, untimed. For what a search does thousands of times a frame in
// the same images; without it a contender's time is that of the caches, which hang on the order.
enum class Caches { kWarm, kAsFound };

// Nanoseconds of CPU per unit, for each contender and turn; one turn before them warms up.
std::vector<std::vector<double>> interleave(const std::vector<Contender>& contenders, int turns,
                                            Caches caches = Caches::kWarm);

}  // namespace gannet::bench
