#include "src/search/symmetric_eigen.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "platform/base/random.hpp"

namespace gannet::search {
namespace {

SmallMatrix random_symmetric(Random& random, std::size_t n) {
  SmallMatrix m = {};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) m[i][j] = m[j][i] = 2 * random.uniform() - 1;
  }
  return m;
}

TEST(SymmetricEigen, rebuilds_the_matrix_from_orthonormal_vectors) {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const std::size_t n = 1 + static_cast<std::size_t>(trial % 8);
    const SmallMatrix m = random_symmetric(random, n);
    SmallMatrix v = {};
    SmallVector d = {};
    symmetric_eigen(m, static_cast<int>(n), v, d);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        double rebuilt = 0;
        double product = 0;
        for (std::size_t k = 0; k < n; ++k) {
          rebuilt += v[i][k] * d[k] * v[j][k];
          product += v[k][i] * v[k][j];
        }
        EXPECT_NEAR(rebuilt, m[i][j], 1e-12);
        EXPECT_NEAR(product, i == j ? 1 : 0, 1e-12);
      }
    }
  }
}

TEST(SymmetricEigen, has_the_eigenvalues_of_an_independent_solver) {
  Random random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const SmallMatrix m = random_symmetric(random, 8);
    SmallMatrix v = {};
    SmallVector d = {};
    symmetric_eigen(m, 8, v, d);
    std::sort(d.begin(), d.end());
    Eigen::Matrix<double, 8, 8> a;
    for (int i = 0; i < 8; ++i) {
      for (int j = 0; j < 8; ++j) {
        a(i, j) = m[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
      }
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 8, 8>> truth(a);
    for (int i = 0; i < 8; ++i) {
      EXPECT_NEAR(truth.eigenvalues()(i), d[static_cast<std::size_t>(i)], 1e-12);
    }
  }
}

}  // namespace
}  // namespace gannet::search
