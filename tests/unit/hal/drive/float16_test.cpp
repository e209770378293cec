#include "hal/drive/float16.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gannet::hal {
namespace {

TEST(Float16, KnownValues) {
  const struct {
    float value;
    std::uint16_t half;
  } cases[] = {{0, 0x0000},      {-0.0f, 0x8000},       {1, 0x3C00},        {-2, 0xC000},
               {65504, 0x7BFF},  {15.5f, 0x4BC0},       {310.5f, 0x5CDA},   {-2.25f, 0xC080},
               {0.1f, 0x2E66},   {0.333333f, 0x3555},   {0x1p-14f, 0x0400}, {0x1p-24f, 0x0001},
               {1e9f, 0x7C00},   {-1e9f, 0xFC00},       {65519.9f, 0x7BFF}, {65520, 0x7C00},
               {0x1p-25f, 0},    {0x1.01p-25f, 0x0001}, {2049, 0x6800},     {2051, 0x6802},
               {1e-10f, 0x0000}, {0x1.FFEp-15f, 0x0400}};
  for (const auto& c : cases) EXPECT_EQ(float16_from(c.value), c.half) << c.value;
}

TEST(Float16, EachHalfComesBack) {
  for (int half = 0; half < 0x10000; ++half) {
    const float value = float_from(static_cast<std::uint16_t>(half));
    if (std::isnan(value)) {
      EXPECT_TRUE(std::isnan(float_from(float16_from(value))));
    } else {
      ASSERT_EQ(float16_from(value), half);
    }
  }
}

TEST(Float16, BetweenTwoHalvesTheNearestWinsAndTiesGoToEven) {
  for (int half = 0; half < 0x7BFF; ++half) {
    const auto low = static_cast<std::uint16_t>(half), high = static_cast<std::uint16_t>(half + 1);
    const float middle = (float_from(low) + float_from(high)) / 2;
    ASSERT_EQ(float16_from(middle), half % 2 == 0 ? low : high);
    ASSERT_EQ(float16_from(std::nextafter(middle, 0.0f)), low);
    ASSERT_EQ(float16_from(std::nextafter(middle, 1e9f)), high);
  }
}

TEST(Float16, NanAndInfinitySurvive) {
  EXPECT_TRUE(std::isnan(float_from(float16_from(std::numeric_limits<float>::quiet_NaN()))));
  EXPECT_EQ(float_from(float16_from(std::numeric_limits<float>::infinity())),
            std::numeric_limits<float>::infinity());
}

}  // namespace
}  // namespace gannet::hal
