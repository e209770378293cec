#include "platform/linux/clock.hpp"

#include <gtest/gtest.h>

namespace gannet::linux_os {
namespace {

TEST(LiveClock, goes_on) {
  const LiveClock sut;
  const TimePoint before = sut.now();
  while (sut.now() == before) {
  }
  EXPECT_GT(sut.now(), before);
}

TEST(SteppedClock, stands_still_until_it_is_set_and_never_goes_back) {
  SteppedClock sut;
  EXPECT_TRUE(sut.set(time_from_ns(500)));
  EXPECT_EQ(sut.now(), time_from_ns(500));
  EXPECT_FALSE(sut.set(time_from_ns(499)));
  EXPECT_EQ(sut.now(), time_from_ns(500));
  EXPECT_TRUE(sut.set(time_from_ns(500)));
}

}  // namespace
}  // namespace gannet::linux_os
