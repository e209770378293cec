// The refinement's sums: every table gives the bits of the plain one, and the slopes are those of
// the images.
#include "src/vision/kernels/refine_sums.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "platform/base/random.hpp"

namespace gannet::vision {
namespace {

constexpr int kWidth = 67, kHeight = 41, kPoints = 152;  // not multiples of a register

class Sums : public testing::Test {
 protected:
  Sums() : plane(static_cast<std::size_t>(kWidth * kHeight)) {
    for (auto& b : plane) b = static_cast<std::uint8_t>(random.below(256));
    for (int i = 0; i < kPoints; ++i) {
      const bool padding = i % 19 == 18;
      const float nan = std::numeric_limits<float>::quiet_NaN();
      x.push_back(padding ? nan : random.uniform_f() - 0.5f);
      y.push_back(padding ? nan : random.uniform_f() - 0.5f);
      z.push_back(0.2f * random.uniform_f() - 0.1f);
      for (int c = 0; c < 3; ++c) colour.push_back(255 * random.uniform_f());
      lens_u.push_back(i % 7 == 0 ? nan : 70 * random.uniform_f());  // some outside
      lens_v.push_back(45 * random.uniform_f());
      slope.push_back(60 * random.uniform_f() - 30);
    }
    eye = {{0.9f, -0.2f, 0.05f, 0.1f, 0.95f, -0.03f, 0.2f, 0.1f, 1.1f},
           {0.2f, 0.1f, 0.97f},
           {0.9f, 0.1f, 0.2f, -0.2f, 0.95f, 0.1f, -0.1f, 0.05f, 0.98f},
           {0.99f, 0.01f, -0.1f, -0.02f, 0.98f, 0.05f, 0.1f, -0.04f, 0.97f},
           {0.3f, -0.2f, 1.4f},
           60,
           55,
           33,
           20,
           {plane.data(), plane.data(), plane.data()},
           kWidth,
           kHeight,
           {{0.8f, 3, 0.01f}, {}, {1.2f, -5, 0.002f}}};
    lens = {lens_u.data(), lens_v.data(), {slope.data(), slope.data(), slope.data(), slope.data()}};
  }
  RefinePart part(bool with_lens, bool with_relief) const {
    return {x.data(), y.data(), with_relief ? z.data() : nullptr, colour.data(),
            kPoints,  0.3f,     with_lens ? &lens : nullptr};
  }
  template <int P>
  static std::vector<double> totals(const RefineSums<P>& sums) {
    std::vector<double> out;
    for (const auto& channel : sums.lanes) {
      for (const auto& lanes : channel) {
        double sum = 0;
        for (const float f : lanes) sum += static_cast<double>(f);
        out.push_back(sum);
      }
    }
    return out;
  }
  Random random{3};
  std::vector<std::uint8_t> plane;
  std::vector<float> x, y, z, colour, lens_u, lens_v, slope;
  RefineEye eye = {};
  LensPart lens = {};
};

TEST_F(Sums, have_the_same_bits_in_every_table) {
  for (const bool with_lens : {false, true}) {
    for (const bool with_relief : {false, true}) {
      RefineSums<6> pose[2];
      kScalarRefineKernels.add_pose(eye, part(with_lens, with_relief), pose[0]);
      refine_kernels().add_pose(eye, part(with_lens, with_relief), pose[1]);
      EXPECT_EQ(std::memcmp(&pose[0], &pose[1], sizeof pose[0]), 0);
      for (const double sum : totals(pose[0])) EXPECT_TRUE(std::isfinite(sum));
      EXPECT_GT(totals(pose[0])[0], 1);
    }
    RefineSums<3> plane_sums[2];
    kScalarRefineKernels.add_plane(eye, part(with_lens, false), plane_sums[0]);
    refine_kernels().add_plane(eye, part(with_lens, false), plane_sums[1]);
    EXPECT_EQ(std::memcmp(&plane_sums[0], &plane_sums[1], sizeof plane_sums[0]), 0);
    for (const double sum : totals(plane_sums[0])) EXPECT_TRUE(std::isfinite(sum));
  }
}

// Of a smooth image the sum Σ w·j is the derivative of Σ w·i.
TEST_F(Sums, have_the_slopes_of_the_image) {
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      plane[static_cast<std::size_t>(row * kWidth + column)] =
          static_cast<std::uint8_t>(3 * column + row);
    }
  }
  const auto& table = refine_kernels();
  eye.fit[0] = eye.fit[1] = eye.fit[2] = {};
  std::memcpy(eye.turn, std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1}.data(), sizeof eye.turn);
  const auto column = [this](int k) {
    return Eigen::Vector3f(eye.h[k], eye.h[3 + k], eye.h[6 + k]);
  };
  const Eigen::Vector3f lever[3] = {column(0), column(1), Eigen::Vector3f(eye.deep)};
  for (int k = 0; k < 9; ++k) eye.arm[k] = lever[k / 3](k % 3);
  for (auto* values : {&x, &y, &z}) {
    for (float& f : *values) f *= 0.3f;  // all inside, before and after
  }
  // The eye with the target moved along an axis, or turned about it.
  const auto moved = [&](int parameter, float step) {
    RefineEye out = eye;
    const Eigen::Vector3f axis = Eigen::Vector3f::Unit(parameter % 3);
    if (parameter < 3) {
      out.h[3 * parameter + 2] += step;
      return out;
    }
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3f turned = lever[k] + step * axis.cross(lever[k]);
      for (int row = 0; row < 3; ++row) (k < 2 ? out.h[3 * row + k] : out.deep[row]) = turned(row);
    }
    return out;
  };
  for (const bool with_relief : {false, true}) {
    RefineSums<6> here;
    table.add_pose(eye, part(false, with_relief), here);
    for (int k = 0; k < 6; ++k) {
      constexpr float kStep = 2e-3f;
      RefineSums<6> there, back;
      table.add_pose(moved(k, kStep), part(false, with_relief), there);
      table.add_pose(moved(k, -kStep), part(false, with_relief), back);
      const double change = (totals(there)[3] - totals(back)[3]) / (2 * static_cast<double>(kStep));
      const double slope_sum = totals(here)[6 + static_cast<std::size_t>(k)];
      EXPECT_NEAR(slope_sum, change, 0.01 * std::abs(change) + 1) << k << with_relief;
    }
  }
}

}  // namespace
}  // namespace gannet::vision
