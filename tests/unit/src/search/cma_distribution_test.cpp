#include "src/search/cma_distribution.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

namespace gannet::search {
namespace {

// The tutorial's Fig. 6 written with a matrix library and the C library's functions.
struct Tutorial {
  Eigen::Vector4d mean{0.5, 0.4, 0.6, 0.5};
  double sigma = 0.2;
  Eigen::Matrix4d c = Eigen::Matrix4d::Identity();
  Eigen::Vector4d p_sigma = Eigen::Vector4d::Zero();
  Eigen::Vector4d p_c = Eigen::Vector4d::Zero();
  int generation = 0;

  void adapt(const std::vector<Eigen::Vector4d>& y, int lambda) {
    const double n = 4;
    const int mu = lambda / 2;
    Eigen::VectorXd w(mu);
    for (int i = 0; i < mu; ++i) w(i) = std::log((lambda + 1) / 2.0) - std::log(i + 1.0);
    w /= w.sum();
    const double mu_eff = 1 / w.squaredNorm();
    const double c_sigma = (mu_eff + 2) / (n + mu_eff + 5);
    const double d_sigma = 1 + 2 * std::max(0.0, std::sqrt((mu_eff - 1) / (n + 1)) - 1) + c_sigma;
    const double c_c = (4 + mu_eff / n) / (n + 4 + 2 * mu_eff / n);
    const double c_1 = 2 / (std::pow(n + 1.3, 2) + mu_eff);
    const double c_mu =
        std::min(1 - c_1, 2 * (mu_eff - 2 + 1 / mu_eff) / (std::pow(n + 2, 2) + mu_eff));
    const double chi = std::sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n));
    Eigen::Vector4d step = Eigen::Vector4d::Zero();
    for (int i = 0; i < mu; ++i) step += w(i) * y[static_cast<std::size_t>(i)];
    mean += sigma * step;
    const Eigen::Matrix4d whiten =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(c).operatorInverseSqrt();
    p_sigma = (1 - c_sigma) * p_sigma + std::sqrt(c_sigma * (2 - c_sigma) * mu_eff) * whiten * step;
    ++generation;
    const double h = p_sigma.norm() / std::sqrt(1 - std::pow(1 - c_sigma, 2 * generation)) <
                             (1.4 + 2 / (n + 1)) * chi
                         ? 1
                         : 0;
    p_c = (1 - c_c) * p_c + h * std::sqrt(c_c * (2 - c_c) * mu_eff) * step;
    c *= 1 - c_1 - c_mu + (1 - h) * c_1 * c_c * (2 - c_c);
    c += c_1 * p_c * p_c.transpose();
    for (int i = 0; i < mu; ++i) {
      c +=
          c_mu * w(i) * y[static_cast<std::size_t>(i)] * y[static_cast<std::size_t>(i)].transpose();
    }
    sigma *= std::exp(c_sigma / d_sigma * (p_sigma.norm() / chi - 1));
  }
};

TEST(CmaDistribution, adapts_as_the_tutorial_says) {
  Random random(6);
  CmaDistribution sut(4);
  sut.start({0.5, 0.4, 0.6, 0.5}, 0.2, 10);
  Tutorial truth;
  for (int generation = 0; generation < 25; ++generation) {
    std::vector<SmallVector> steps;
    for (int k = 0; k < 10; ++k) steps.push_back(sut.draw_step(random));
    // Always up along the first coordinate: the path grows long, so that both cases of h occur.
    std::sort(steps.begin(), steps.end(),
              [&](const SmallVector& a, const SmallVector& b) { return a[0] > b[0]; });
    std::vector<Eigen::Vector4d> y;
    for (const SmallVector& s : steps) y.emplace_back(s[0], s[1], s[2], s[3]);
    if (sut.sigma() > 0.99) break;  // ours stops growing at the box's width
    sut.adapt([&](int k) -> const SmallVector& { return steps[static_cast<std::size_t>(k)]; });
    truth.adapt(y, 10);
    if (truth.sigma > 1) break;
    EXPECT_NEAR(sut.sigma(), truth.sigma, 1e-9 * truth.sigma);
    for (int i = 0; i < 4; ++i) {
      const std::size_t row = static_cast<std::size_t>(i);
      EXPECT_NEAR(sut.mean()[row], truth.mean(i), 1e-9);
      for (int j = 0; j < 4; ++j) {
        EXPECT_NEAR(sut.covariance()[row][static_cast<std::size_t>(j)], truth.c(i, j), 1e-9);
      }
    }
  }
  EXPECT_GE(truth.generation, 5);
}

// The covariance after many generations under a known selection approaches the selected shape:
// where only the first coordinate matters, its axis shortens against the others.
TEST(CmaDistribution, narrows_along_the_coordinate_that_is_selected) {
  Random random(2);
  CmaDistribution sut(2);
  sut.start({0.5, 0.5}, 0.2, 12);
  for (int generation = 0; generation < 60; ++generation) {
    std::vector<SmallVector> steps;
    for (int k = 0; k < 12; ++k) steps.push_back(sut.draw_step(random));
    const double x = sut.mean()[0];
    std::sort(steps.begin(), steps.end(), [&](const SmallVector& a, const SmallVector& b) {
      return std::abs(x + sut.sigma() * a[0] - 0.3) < std::abs(x + sut.sigma() * b[0] - 0.3);
    });
    sut.adapt([&](int k) -> const SmallVector& { return steps[static_cast<std::size_t>(k)]; });
  }
  EXPECT_NEAR(sut.mean()[0], 0.3, 0.02);
  EXPECT_LT(sut.shortest_axis(), 0.05 * sut.longest_axis());
}

TEST(CmaDistribution, draws_from_a_standard_normal_at_first) {
  Random random(2);
  CmaDistribution sut(3);
  sut.start({}, 1, 9);
  double sum = 0;
  double square = 0;
  for (int i = 0; i < 20000; ++i) {
    const double y = sut.draw_step(random)[static_cast<std::size_t>(i % 3)];
    sum += y;
    square += y * y;
  }
  EXPECT_NEAR(sum / 20000, 0, 0.03);
  EXPECT_NEAR(square / 20000, 1, 0.04);
}

}  // namespace
}  // namespace gannet::search
