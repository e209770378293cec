#include "src/search/symmetric_eigen.hpp"

#include <cmath>

namespace gannet::search {
namespace {

// The rotation in the plane (p, q) that makes a[p][q] zero (Golub & Van Loan, §8.5.2).
void rotate(SmallMatrix& a, SmallMatrix& v, std::size_t n, std::size_t p, std::size_t q) {
  if (a[p][q] == 0) return;
  const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
  const double root = std::sqrt(theta * theta + 1);
  const double t = theta >= 0 ? 1 / (theta + root) : -1 / (root - theta);
  const double c = 1 / std::sqrt(t * t + 1);
  const double s = t * c;
  for (std::size_t k = 0; k < n; ++k) {
    const double akp = a[k][p];
    const double akq = a[k][q];
    a[k][p] = c * akp - s * akq;
    a[k][q] = s * akp + c * akq;
  }
  for (std::size_t k = 0; k < n; ++k) {
    const double apk = a[p][k];
    const double aqk = a[q][k];
    a[p][k] = c * apk - s * aqk;
    a[q][k] = s * apk + c * aqk;
    const double vkp = v[k][p];
    const double vkq = v[k][q];
    v[k][p] = c * vkp - s * vkq;
    v[k][q] = s * vkp + c * vkq;
  }
}

}  // namespace

void symmetric_eigen(const SmallMatrix& matrix, int n, SmallMatrix& vectors, SmallVector& values) {
  SmallMatrix a = matrix;
  const std::size_t size = static_cast<std::size_t>(n);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) vectors[i][j] = i == j ? 1 : 0;
  }
  constexpr int kSweeps = 20;  // convergence is quadratic: seven are usual for 8 × 8
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double off = 0;
    double all = 0;
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = 0; j < size; ++j) {
        all += a[i][j] * a[i][j];
        if (i != j) off += a[i][j] * a[i][j];
      }
    }
    if (off <= 1e-30 * all) break;
    for (std::size_t p = 0; p + 1 < size; ++p) {
      for (std::size_t q = p + 1; q < size; ++q) rotate(a, vectors, size, p, q);
    }
  }
  for (std::size_t i = 0; i < size; ++i) values[i] = a[i][i];
}

}  // namespace gannet::search
