#include "hal/camera/v4l2_pair.hpp"

#include <gtest/gtest.h>

#include "platform/base/random.hpp"

namespace gannet::hal {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr Duration kPeriod = milliseconds(40);

class PairByTimeTest : public ::testing::Test {
 protected:
  void put(PairByTime::Side side, Duration stamp, std::uint64_t number = 0) {
    sut_.put(side, {.lease = (side == PairByTime::kLeft ? left_pool_ : right_pool_).lend(),
                    .bytes = {},
                    .stamp = TimePoint(stamp),
                    .exposure = TimePoint(stamp),
                    .number = number});
  }
  bool take() { return sut_.take(left_, right_); }
  static Duration ms(int n) { return milliseconds(n); }

  LeasePool left_pool_{64}, right_pool_{64};
  V4l2Image left_, right_;
  PairByTime sut_{milliseconds(5), kPeriod};
};

TEST_F(PairByTimeTest, images_within_the_tolerance_are_twins_whoever_comes_first) {
  put(PairByTime::kLeft, ms(100));
  EXPECT_FALSE(take());
  put(PairByTime::kRight, ms(105));
  ASSERT_TRUE(take());
  EXPECT_EQ(sut_.skew(), ms(5));
  put(PairByTime::kRight, ms(140));
  EXPECT_FALSE(take());
  put(PairByTime::kLeft, ms(141));
  ASSERT_TRUE(take());
  EXPECT_EQ(left_.stamp, TimePoint(ms(141)));
  EXPECT_EQ(right_.stamp, TimePoint(ms(140)));
  EXPECT_EQ(sut_.skew(), ms(-1));
  EXPECT_EQ(sut_.largest_skew(), ms(5));
  EXPECT_EQ(sut_.unpaired(), 0u);
}

TEST_F(PairByTimeTest, one_whose_twin_is_lost_goes_home_alone) {
  put(PairByTime::kLeft, ms(100));
  put(PairByTime::kLeft, ms(140));
  put(PairByTime::kRight, ms(140));
  ASSERT_TRUE(take());
  EXPECT_EQ(left_.stamp, right_.stamp);
  EXPECT_EQ(sut_.unpaired(), 1u);
  EXPECT_EQ(left_pool_.free_count(), 63);
  EXPECT_EQ(sut_.largest_skew(), Duration{});  // that of neighbours is none
}

TEST_F(PairByTimeTest, beyond_the_tolerance_nothing_pairs_and_the_skew_tells_why) {
  for (int i = 0; i < 10; ++i) {
    put(PairByTime::kLeft, ms(100 + 40 * i));
    EXPECT_FALSE(take());
    put(PairByTime::kRight, ms(115 + 40 * i));
    EXPECT_FALSE(take());
  }
  EXPECT_EQ(sut_.skew(), ms(15));
  EXPECT_EQ(sut_.unpaired(), 19u);
}

TEST_F(PairByTimeTest, one_camera_s_images_may_come_two_later_than_the_other_s) {
  for (int i = 0; i < 20; ++i) {
    put(PairByTime::kLeft, ms(100 + 40 * i));
    if (i < 2) continue;
    put(PairByTime::kRight, ms(100 + 40 * (i - 2)));
    ASSERT_TRUE(take());
    EXPECT_EQ(left_.stamp, right_.stamp);
  }
  EXPECT_EQ(sut_.unpaired(), 0u);
}

TEST_F(PairByTimeTest, a_side_that_waits_in_vain_holds_three_images_at_most) {
  for (int i = 0; i < 50; ++i) put(PairByTime::kLeft, ms(40 * i));
  EXPECT_EQ(left_pool_.free_count(), 61);
  EXPECT_EQ(sut_.unpaired(), 47u);
  sut_.clear(PairByTime::kLeft);
  EXPECT_EQ(left_pool_.free_count(), 64);
  EXPECT_EQ(sut_.unpaired(), 50u);
}

// Two cameras of one period, out of step by less than the tolerance with jitter, each losing
// images at random: every pair is of one exposure, none of two that both came is missed.
TEST(PairByTime, finds_all_twins_and_only_twins) {
  Random random(11);
  for (int run = 0; run < 30; ++run) {
    LeasePool pool(64);
    PairByTime sut(milliseconds(5), kPeriod);
    const Duration offset = microseconds(random.below(6000) - 3000);
    int twins = 0, pairs = 0;
    std::uint64_t put = 0;
    V4l2Image left, right;
    for (std::uint64_t i = 1; i <= 500; ++i) {
      const bool has_left = random.below(5) != 0, has_right = random.below(5) != 0;
      const auto image = [&](Duration shift) {
        ++put;
        const TimePoint stamp(kPeriod * i + shift + microseconds(random.below(1000)));
        return V4l2Image{pool.lend(), {}, stamp, stamp, i};
      };
      const bool right_first = random.below(2) == 0;
      if (has_right && right_first) sut.put(PairByTime::kRight, image(offset));
      if (has_left) sut.put(PairByTime::kLeft, image({}));
      if (has_right && !right_first) sut.put(PairByTime::kRight, image(offset));
      twins += has_left && has_right ? 1 : 0;
      while (sut.take(left, right)) {
        ++pairs;
        EXPECT_EQ(left.number, right.number);
        EXPECT_LE(std::chrono::abs(sut.skew()), milliseconds(5));
      }
    }
    EXPECT_EQ(pairs, twins);
    sut.clear(PairByTime::kLeft);
    sut.clear(PairByTime::kRight);
    EXPECT_EQ(sut.unpaired() + 2 * static_cast<std::uint64_t>(pairs), put);
    left = V4l2Image{};
    right = V4l2Image{};
    EXPECT_EQ(pool.free_count(), 64);
  }
}

}  // namespace
}  // namespace gannet::hal
