#include "hal/drive/esc_range.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace gannet::hal {
namespace {

TEST(EscRange, CommandAndFractionAreInverse) {
  for (const char* name : {"reversible", "forward_only", "pwm_centred"}) {
    const EscRange range = *esc_range(name);
    for (double fraction = -1; fraction <= 1; fraction += 0.125) {
      const bool can = fraction >= 0 || range.reverse != range.stop;
      EXPECT_NEAR(fraction_of(range, command_of(range, fraction)), can ? fraction : 0, 2e-4);
    }
    EXPECT_EQ(fraction_of(range, 8191), 1);
    EXPECT_EQ(fraction_of(range, range.stop), 0);
  }
  EXPECT_EQ(fraction_of(*esc_range("reversible"), -8192), -1);
  EXPECT_FALSE(esc_range("sideways"));
}

TEST(EscRange, FractionsBeyondTheRangeAreClampedAndNanStops) {
  const EscRange centred = *esc_range("pwm_centred");
  EXPECT_EQ(command_of(centred, 7), 8191);
  EXPECT_EQ(command_of(centred, -7), 1);
  EXPECT_EQ(command_of(centred, std::numeric_limits<double>::infinity()), 8191);
  EXPECT_EQ(command_of(centred, std::numeric_limits<double>::quiet_NaN()), 4096);
}

}  // namespace
}  // namespace gannet::hal
