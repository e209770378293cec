#include "src/search/exact_math.hpp"

#include <algorithm>

namespace gannet::search {

// exp(x) = exp(x / 256)^256: the Taylor series converges at once where |x / 256| < 0.1.
double exact_exp(double x) {
  const double small = std::clamp(x, -20.0, 20.0) / 256;
  // Horner, from the smallest term; the 12th is below 1e-21.
  double sum = 1;
  for (int k = 12; k >= 1; --k) sum = 1 + sum * small / k;
  for (int i = 0; i < 8; ++i) sum *= sum;
  return sum;
}

// log(x) = e·log(2) + 2·artanh((m − 1) / (m + 1)), m = x / 2^e in [0.7, 1.5].
double exact_log(double x) {
  constexpr double kLog2 = 0.693147180559945309417;
  double m = std::clamp(x, 1e-6, 1e6);
  int e = 0;
  for (; m > 1.5; m /= 2) ++e;
  for (; m < 0.7; m *= 2) --e;
  const double t = (m - 1) / (m + 1);
  double sum = 0;
  for (int k = 41; k >= 1; k -= 2) sum = sum * t * t + 1.0 / k;
  return e * kLog2 + 2 * t * sum;
}

}  // namespace gannet::search
