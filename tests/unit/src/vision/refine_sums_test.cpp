// The refinement's sums: every table gives the bits of the plain one, and the slopes are those of
// the images.
#include "src/vision/kernels/refine_sums.hpp"

#include <gtest/gtest.h>

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
      for (int c = 0; c < 3; ++c) colour.push_back(255 * random.uniform_f());
      lens_u.push_back(i % 7 == 0 ? nan : 70 * random.uniform_f());  // some outside
      lens_v.push_back(45 * random.uniform_f());
      slope.push_back(60 * random.uniform_f() - 30);
    }
    eye = {{0.9f, -0.2f, 0.05f, 0.1f, 0.95f, -0.03f, 0.2f, 0.1f, 1.1f},
           {0.9f, 0.1f, 0.2f, -0.2f, 0.95f, 0.1f},
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
  RefinePart part(bool with_lens) const {
    return {x.data(), y.data(), colour.data(), kPoints, 0.3f, with_lens ? &lens : nullptr};
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
  std::vector<float> x, y, colour, lens_u, lens_v, slope;
  RefineEye eye = {};
  LensPart lens = {};
};

TEST_F(Sums, have_the_same_bits_in_every_table) {
  for (const bool with_lens : {false, true}) {
    RefineSums<6> pose[2];
    kScalarRefineKernels.add_pose(eye, part(with_lens), pose[0]);
    refine_kernels().add_pose(eye, part(with_lens), pose[1]);
    EXPECT_EQ(std::memcmp(&pose[0], &pose[1], sizeof pose[0]), 0);
    RefineSums<3> plane_sums[2];
    kScalarRefineKernels.add_plane(eye, part(with_lens), plane_sums[0]);
    refine_kernels().add_plane(eye, part(with_lens), plane_sums[1]);
    EXPECT_EQ(std::memcmp(&plane_sums[0], &plane_sums[1], sizeof plane_sums[0]), 0);
    for (const double sum : totals(pose[0])) EXPECT_TRUE(std::isfinite(sum));
    for (const double sum : totals(plane_sums[0])) EXPECT_TRUE(std::isfinite(sum));
    EXPECT_GT(totals(pose[0])[0], 1);
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
  const float arm[6] = {eye.h[0], eye.h[3], eye.h[6], eye.h[1], eye.h[4], eye.h[7]};
  std::memcpy(eye.arm, arm, sizeof arm);
  for (float& f : x) f *= 0.3f;  // all inside, before and after
  for (float& f : y) f *= 0.3f;
  RefineSums<6> here;
  table.add_pose(eye, part(false), here);
  for (int k = 0; k < 3; ++k) {
    constexpr float kStep = 2e-3f;
    RefineSums<6> there, back;
    RefineEye moved = eye;
    moved.h[3 * k + 2] += kStep;
    table.add_pose(moved, part(false), there);
    moved.h[3 * k + 2] -= 2 * kStep;
    table.add_pose(moved, part(false), back);
    const double change = (totals(there)[3] - totals(back)[3]) / (2 * static_cast<double>(kStep));
    const double slope_sum = totals(here)[6 + static_cast<std::size_t>(k)];
    EXPECT_NEAR(slope_sum, change, 0.01 * std::abs(change) + 1) << k;
  }
}

}  // namespace
}  // namespace gannet::vision
