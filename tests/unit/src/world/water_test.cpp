#include "src/world/water.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace gannet::world {
namespace {

double formula(const Water& w, std::size_t c, double light, double range_m) {
  return light * std::exp(-w.attenuation_per_m[c] * range_m) +
         w.veil[c] * (1 - std::exp(-w.backscatter_per_m[c] * range_m));
}

TEST(Water, FollowsTheFormulaPerChannelAtEveryRange) {
  for (const Water& water : {Water{}, pool_water(), coastal_water(), turbid_water()}) {
    const WaterTable sut(water);
    for (double range_m = 0; range_m < 15.9; range_m += 0.0137) {
      const Float4 seen = sut.seen(Float4{0.8f, 0.5f, 0.2f, 1}, static_cast<float>(range_m));
      EXPECT_NEAR(double{seen[0]}, formula(water, 0, 0.8, range_m), 1e-4);
      EXPECT_NEAR(double{seen[1]}, formula(water, 1, 0.5, range_m), 1e-4);
      EXPECT_NEAR(double{seen[2]}, formula(water, 2, 0.2, range_m), 1e-4);
      EXPECT_EQ(seen[3], 1.0f);
    }
  }
}

TEST(Water, AHalfCoveredPixelHasHalfTheVeilBeforeIt) {
  const WaterTable sut(turbid_water());
  const Float4 whole = sut.seen(Float4{0.6f, 0.6f, 0.6f, 1}, 1.5f);
  const Float4 half = sut.seen(Float4{0.3f, 0.3f, 0.3f, 0.5f}, 1.5f);
  for (int c = 0; c < 4; ++c) EXPECT_NEAR(double{half[c]}, 0.5 * double{whole[c]}, 1e-6);
}

TEST(Water, FarSurfacesSinkIntoTheVeil) {
  const WaterTable sut(turbid_water());
  const Float4 far = sut.seen(Float4{1, 1, 1, 1}, 1000);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(double{far[c]}, double{sut.endless()[c]}, 1e-4);
}

}  // namespace
}  // namespace gannet::world
