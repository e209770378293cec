#include "src/vision/bent_points.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

namespace gannet::vision {
namespace {

constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();

float narrow(double x) { return static_cast<float>(x); }
std::size_t at(int k) { return static_cast<std::size_t>(k); }

}  // namespace

LensPart BentPoints::part() const {
  return {u_.data(),
          v_.data(),
          {slopes_[0].data(), slopes_[1].data(), slopes_[2].data(), slopes_[3].data()}};
}

void BentPoints::fill(const RefineEye& eye, const RefinePart& part, bool rays) {
  place(eye, part, rays);
  if (port_ != nullptr) pass_port(part.n);
  normalise(part.n);
  if (camera_.distortion == Distortion::kBrown) distort_brown(part.n);
  if (camera_.distortion == Distortion::kFisheye) distort_fisheye(part.n);
  to_pixels(part.n);
}

void BentPoints::place(const RefineEye& eye, const RefinePart& part, bool rays) {
  const float* const h = eye.h;
  for (int i = 0; i < part.n; ++i) {
    const std::size_t k = at(i);
    const float x = part.x[i], y = part.y[i];
    x_[k] = (h[0] * x + h[1] * y) + h[2];
    y_[k] = (h[3] * x + h[4] * y) + h[5];
    z_[k] = (h[6] * x + h[7] * y) + h[8];
  }
  if (rays) {
    for (int i = 0; i < part.n; ++i) {
      const std::size_t k = at(i);
      const float by = 1 / ((eye.plane[0] * part.x[i] + eye.plane[1] * part.y[i]) + eye.plane[2]);
      x_[k] = x_[k] * by + eye.arm[0];
      y_[k] = y_[k] * by + eye.arm[1];
      z_[k] = z_[k] * by + eye.arm[2];
    }
  } else if (part.z != nullptr) {
    for (int i = 0; i < part.n; ++i) {
      const std::size_t k = at(i);
      x_[k] += eye.deep[0] * part.z[i];
      y_[k] += eye.deep[1] * part.z[i];
      z_[k] += eye.deep[2] * part.z[i];
    }
  }
  for (int i = 0; i < part.n; ++i) {
    depth_[at(i)] = z_[at(i)];
    turn_x_[at(i)] = turn_y_[at(i)] = 0;
  }
}

// p + (v − w) · axis, v² = w² · of(q, 1/w): src/vision/port_optics.hpp.
void BentPoints::pass_port(int n) {
  const float ax = narrow(port_->axis()[0]), ay = narrow(port_->axis()[1]),
              az = narrow(port_->axis()[2]);
  const float nearest = narrow(port_->nearest_m());
  const PortOptics::Narrow optics = port_->narrow();
  for (int i = 0; i < n; ++i) {
    const std::size_t k = at(i);
    const float x = x_[k], y = y_[k], z = z_[k];
    const float w = (ax * x + ay * y) + az * z;
    const float l = 1 / w;
    // Across the axis: |p|² − w² would lose the digits that the angle is made of.
    const float cx = ay * z - az * y, cy = az * x - ax * z, cz = ax * y - ay * x;
    const float q = ((cx * cx + cy * cy) + cz * cz) * (l * l);
    const PortOptics::Narrow::Squared of = optics.squared(q, l);
    const float ratio2 = (of.offset + of.by_q * q) + of.by_lambda * l;
    const float ratio = std::sqrt(ratio2);  // NaN where no light passes
    const float add = (ratio - 1) * w;
    // d(v²)/dp = along · axis + across · p, less the axis of the w that v replaces.
    const float along = (2 * w * ratio2 - 2 * of.by_q * ((q + 1) * w)) - of.by_lambda;
    const float across = 2 * of.by_q;
    const float half = 0.5f / (ratio * w);
    turn_x_[k] = (along * ax + across * x) * half - ax;
    turn_y_[k] = (along * ay + across * y) * half - ay;
    x_[k] = x + add * ax;
    y_[k] = y + add * ay;
    z_[k] = z + add * az;
    u_[k] = w;
  }
  for (int i = 0; i < n; ++i) z_[at(i)] = u_[at(i)] > nearest ? z_[at(i)] : kNowhere;
}

void BentPoints::normalise(int n) {
  float ax = 0, ay = 0, az = 0;
  if (port_ != nullptr)
    ax = narrow(port_->axis()[0]), ay = narrow(port_->axis()[1]), az = narrow(port_->axis()[2]);
  const float most = narrow(radius2_);
  for (int i = 0; i < n; ++i) {
    const std::size_t k = at(i);
    const float by = 1 / z_[k];
    const float a = x_[k] * by, b = y_[k] * by;
    // Bit by bit: a branch would keep the compiler from doing points side by side.
    const int seen = static_cast<int>(z_[k] > 1e-6f) & static_cast<int>(a * a + b * b <= most);
    u_[k] = seen != 0 ? a : kNowhere;
    v_[k] = seen != 0 ? b : kNowhere;
    // By the point's x/z and y/z, as the kernels have it.
    const float scale = by * depth_[k];
    const float to_a = ax - a * az, to_b = ay - b * az;
    slopes_[0][k] = (1 + turn_x_[k] * to_a) * scale;
    slopes_[1][k] = turn_y_[k] * to_a * scale;
    slopes_[2][k] = turn_x_[k] * to_b * scale;
    slopes_[3][k] = (1 + turn_y_[k] * to_b) * scale;
  }
}

// Intrinsics::distort and its derivative.
void BentPoints::distort_brown(int n) {
  const auto& c = camera_.coefficients;
  const float k1 = narrow(c[0]), k2 = narrow(c[1]), p1 = narrow(c[2]), p2 = narrow(c[3]),
              k3 = narrow(c[4]);
  for (int i = 0; i < n; ++i) {
    const std::size_t k = at(i);
    const float a = u_[k], b = v_[k];
    const float t = a * a + b * b;
    const float scale = 1 + t * (k1 + t * (k2 + t * k3));
    const float slope = 2 * (k1 + t * (2 * k2 + t * (3 * k3)));
    u_[k] = (a * scale + 2 * p1 * (a * b)) + p2 * (t + 2 * (a * a));
    v_[k] = (b * scale + 2 * p2 * (a * b)) + p1 * (t + 2 * (b * b));
    const float aa = scale + slope * (a * a) + 2 * (p1 * b) + 6 * (p2 * a);
    const float ab = slope * (a * b) + 2 * (p1 * a) + 2 * (p2 * b);
    const float bb = scale + slope * (b * b) + 6 * (p1 * b) + 2 * (p2 * a);
    const float s0 = slopes_[0][k], s1 = slopes_[1][k], s2 = slopes_[2][k], s3 = slopes_[3][k];
    slopes_[0][k] = aa * s0 + ab * s2;
    slopes_[1][k] = aa * s1 + ab * s3;
    slopes_[2][k] = ab * s0 + bb * s2;
    slopes_[3][k] = ab * s1 + bb * s3;
  }
}

void BentPoints::distort_fisheye(int n) {
  constexpr double kStep = 1e-6;
  for (int i = 0; i < n; ++i) {
    const std::size_t k = at(i);
    const Eigen::Vector2d before(static_cast<double>(u_[k]), static_cast<double>(v_[k]));
    const Eigen::Vector2d after = camera_.distort(before);
    Eigen::Matrix2d by_before, slopes;
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(axis);
      by_before.col(axis) =
          (camera_.distort(before + step) - camera_.distort(before - step)) / (2 * kStep);
    }
    for (int s = 0; s < 4; ++s) slopes(s / 2, s % 2) = static_cast<double>(slopes_[at(s)][k]);
    slopes = by_before * slopes;
    for (int s = 0; s < 4; ++s) slopes_[at(s)][k] = narrow(slopes(s / 2, s % 2));
    u_[k] = narrow(after.x());
    v_[k] = narrow(after.y());
  }
}

void BentPoints::to_pixels(int n) {
  const float fx = narrow(camera_.fx), fy = narrow(camera_.fy);
  const float cx = narrow(camera_.cx), cy = narrow(camera_.cy);
  for (int i = 0; i < n; ++i) {
    const std::size_t k = at(i);
    u_[k] = fx * u_[k] + cx;
    v_[k] = fy * v_[k] + cy;
    slopes_[0][k] *= fx;
    slopes_[1][k] *= fx;
    slopes_[2][k] *= fy;
    slopes_[3][k] *= fy;
  }
  for (Row& slope : slopes_) {
    for (int i = 0; i < n; ++i) slope[at(i)] = u_[at(i)] == u_[at(i)] ? slope[at(i)] : 0;  // NaN
  }
}

}  // namespace gannet::vision
