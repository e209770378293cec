// Statistics of measured samples for reports. Units are the samples'. An empty sample gives NaN,
// never a number that looks measured. Any thread; not for real-time threads (they sort a copy).
#pragma once

#include <span>

namespace gannet::report {

double mean(std::span<const double> values);
double rms(std::span<const double> values);
double standard_deviation(std::span<const double> values);  // of the sample, n − 1; n = 1 gives 0

// percent in [0, 100], linear between the two nearest ranks (0: least, 50: median, 100: greatest).
double percentile(std::span<const double> values, double percent);

struct Summary {
  int count = 0;
  double mean, rms, deviation, min, p50, p90, p99, max;
};
Summary summarise(std::span<const double> values);

// 95 % interval of a share, successes of trials (Wilson, J. Am. Stat. Assoc. 22, 1927): never
// empty and never beyond [0, 1], also at 0 and all. No trials: [0, 1].
struct Interval {
  double low = 0;
  double high = 1;
};
Interval wilson95(int successes, int trials);

// 95 % interval of the mean number of events where so many were counted (exact for Poisson's law:
// F. Garwood, Biometrika 28, 1936). Divide by the time watched for a rate.
Interval poisson95(int events);

// 95 % interval of the mean of a normal population (Student's t). Less than two values: NaN.
struct MeanInterval {
  double low, high;
};
MeanInterval mean95(std::span<const double> values);

}  // namespace gannet::report
