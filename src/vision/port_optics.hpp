// PortOptics: a flat port as search and refinement use it: no iteration, but a polynomial made once
// from the exact solution (src/core/flat_port.hpp); docs/design/refraction.md.
//
// Points are told from the pupil, where lines near the port's axis meet. A point p with depth w
// along the axis is seen in air along p + (v − w) · axis, for some v. Of q = tan² of its angle to
// the axis and λ = 1/w, (v/w)² is a plane for a port that touches the camera, and nearly one for
// all others: so v is the root of a quadratic form of p, about any point that one likes. Made at
// start-up; reading is RT safe: IEEE arithmetic alone, in a fixed order.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>

#include "src/core/stereo_rig.hpp"

namespace gannet::vision {

class PortOptics {
  static constexpr std::size_t kQ = 5, kLambda = 3;

 public:
  PortOptics() = default;  // no port: nothing of it may be asked
  explicit PortOptics(const Intrinsics& camera);

  // Where the pupil is, in the camera's frame, and the axis, unit.
  const std::array<double, 3>& pupil() const { return pupil_; }
  const std::array<double, 3>& axis() const { return axis_; }
  // Points nearer to the pupil than this, along the axis, are not in the water.
  double nearest_m() const { return nearest_m_; }

  // (v/w)² is this: exact at the point asked for, or at the nearest one that was fitted.
  struct Squared {
    double offset, by_q, by_lambda;
    double at(double q, double lambda) const { return (offset + by_q * q) + by_lambda * lambda; }
  };
  Squared squared(double asked_q, double asked_lambda) const {
    const double q = std::min(asked_q, largest_q_);
    const double l = std::min(asked_lambda, largest_lambda_);
    double z[2] = {0, 0};  // the polynomial over q and its derivative by q, without what λ does
    double by_l = 0;
    for (std::size_t i = kQ; i-- > 0;) {
      const auto& c = coefficients_[i];
      const double at = c[0] + l * (c[1] + l * c[2]);
      z[1] = z[1] * q + z[0];
      z[0] = z[0] * q + at;
      by_l = by_l * q + (c[1] + 2 * l * c[2]);
    }
    const double value = flat_ - (1 - flat_) * q + l * (q * z[0]);
    const double by_q = l * (z[0] + q * z[1]) - (1 - flat_);
    const double by_lambda = q * (z[0] + l * by_l);
    return {value - by_q * q - by_lambda * l, by_q, by_lambda};
  }

  // The same of single floats, by value, for loops over many points.
  struct Narrow {
    struct Squared {
      float offset, by_q, by_lambda;
    };
    Squared squared(float asked_q, float asked_l) const {
      const float q = asked_q < largest_q ? asked_q : largest_q;
      const float l = asked_l < largest_lambda ? asked_l : largest_lambda;
      float z0 = 0, z1 = 0, by_l = 0;
      const auto step = [&](const float* c) {
        z1 = z1 * q + z0;
        z0 = z0 * q + (c[0] + l * (c[1] + l * c[2]));
        by_l = by_l * q + (c[1] + 2 * l * c[2]);
      };
      static_assert(kQ == 5);  // one by one: a loop would keep points from going side by side
      step(coefficients[4]), step(coefficients[3]), step(coefficients[2]);
      step(coefficients[1]), step(coefficients[0]);
      const float by_q = l * (z0 + q * z1) - (1 - flat);
      const float by_lambda = q * (z0 + l * by_l);
      const float value = (flat - (1 - flat) * q) + l * (q * z0);
      return {(value - by_q * q) - by_lambda * l, by_q, by_lambda};
    }
    float largest_q, largest_lambda, flat;
    float coefficients[kQ][kLambda];
  };
  Narrow narrow() const {
    Narrow n = {static_cast<float>(largest_q_),
                static_cast<float>(largest_lambda_),
                static_cast<float>(flat_),
                {}};
    for (std::size_t i = 0; i < kQ; ++i)
      for (std::size_t k = 0; k < kLambda; ++k)
        n.coefficients[i][k] = static_cast<float>(coefficients_[i][k]);
    return n;
  }

 private:
  void fit(const FlatPort& port);

  std::array<double, 3> pupil_ = {}, axis_ = {0, 0, 1};
  double nearest_m_ = 0;
  double largest_q_ = 0, largest_lambda_ = 0;  // that were fitted
  double flat_ = 1;                            // (v/w)² on the axis
  // Of what a port that stands off adds, less its factor λ·q: by powers of q, then of λ.
  std::array<std::array<double, kLambda>, kQ> coefficients_ = {};
};

// A rig with what its lenses and ports need again and again.
struct RigOptics {
  StereoRig rig;
  PortOptics left, right;
  double left_radius2, right_radius2;  // normalised, up to which the lenses are one-to-one

  // Implicit: a pinhole needs no more. Start-up only with lenses and ports.
  RigOptics(const StereoRig& of)
      : rig(of),
        left(of.left.port ? PortOptics(of.left) : PortOptics()),
        right(of.right.port ? PortOptics(of.right) : PortOptics()),
        left_radius2(of.left.valid_radius() * of.left.valid_radius()),
        right_radius2(of.right.valid_radius() * of.right.valid_radius()) {}
};

}  // namespace gannet::vision
