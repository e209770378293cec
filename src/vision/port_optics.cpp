#include "src/vision/port_optics.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace gannet::vision {
namespace {

constexpr double kNearestFitted_m = 0.1;  // beyond the glass; nearer points are as if there

// tan² of the angle in water, to the port's axis, of what the image's border shows.
double seen_q(const Intrinsics& camera) {
  constexpr int kSteps = 16;
  double largest = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double x = i * (camera.width - 1.0) / kSteps, y = i * (camera.height - 1.0) / kSteps;
    for (const Eigen::Vector2d& pixel :
         {Eigen::Vector2d(x, 0), Eigen::Vector2d(x, camera.height - 1.0), Eigen::Vector2d(0, y),
          Eigen::Vector2d(camera.width - 1.0, y)}) {
      const auto line = camera.line(pixel);
      if (!line) continue;
      const double along = camera.port->normal.dot(line->direction);
      if (along > 0)
        largest = std::max(largest, line->direction.squaredNorm() / (along * along) - 1);
    }
  }
  return std::max(largest, 0.01);
}

// Chebyshev's nodes of [0, end]: an interpolation there errs evenly.
double node(int i, int n, double end) {
  return end * 0.5 * (1 - std::cos(std::numbers::pi * (i + 0.5) / n));
}

}  // namespace

PortOptics::PortOptics(const Intrinsics& camera) {
  const FlatPort& port = *camera.port;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    axis_[k] = port.normal(at);
    pupil_[k] = port.pupil_m() * port.normal(at);
  }
  nearest_m_ = port.distance_m + port.thickness_m - port.pupil_m();
  largest_lambda_ = 1 / (nearest_m_ + kNearestFitted_m);
  flat_ = (port.air_index / port.water_index) * (port.air_index / port.water_index);
  largest_q_ = 1.1 * seen_q(camera);
  fit(port);
}

void PortOptics::fit(const FlatPort& port) {
  constexpr int kNodesQ = 16, kNodesLambda = 8;
  constexpr auto kTerms = static_cast<Eigen::Index>(kQ * kLambda);
  Eigen::Matrix<double, kNodesQ * kNodesLambda, kTerms> terms;
  Eigen::Matrix<double, kNodesQ * kNodesLambda, 1> wanted;
  const Eigen::Vector3d outwards = port.normal.unitOrthogonal();
  Eigen::Index row = 0;
  for (int i = 0; i < kNodesQ; ++i) {
    for (int j = 0; j < kNodesLambda; ++j, ++row) {
      const double q = node(i, kNodesQ, largest_q_), l = node(j, kNodesLambda, largest_lambda_);
      const Eigen::Vector3d point =
          port.normal * (1 / l + port.pupil_m()) + outwards * (std::sqrt(q) / l);
      const auto ray = port.air_ray(point);
      const double air_tangent = ray ? outwards.dot(*ray) : std::sqrt(q / flat_);
      const double flat = flat_ - (1 - flat_) * q;
      // An error of (v/w)² moves a pixel the more the farther it is from the axis.
      const double weight = std::sqrt(q);
      wanted(row) = weight * (q / (air_tangent * air_tangent) - flat);
      for (std::size_t a = 0; a < kQ; ++a)
        for (std::size_t b = 0; b < kLambda; ++b)
          terms(row, static_cast<Eigen::Index>(a * kLambda + b)) =
              weight * std::pow(q, static_cast<double>(a + 1)) *
              std::pow(l, static_cast<double>(b + 1));
    }
  }
  // Columns of like size, or the solution's rounding would be that of the largest.
  const Eigen::Matrix<double, kTerms, 1> size = terms.colwise().norm();
  for (Eigen::Index k = 0; k < kTerms; ++k) terms.col(k) /= size(k);
  const Eigen::Matrix<double, kTerms, 1> found = terms.colPivHouseholderQr().solve(wanted);
  for (std::size_t a = 0; a < kQ; ++a)
    for (std::size_t b = 0; b < kLambda; ++b) {
      const auto k = static_cast<Eigen::Index>(a * kLambda + b);
      coefficients_[a][b] = found(k) / size(k);
    }
}

}  // namespace gannet::vision
