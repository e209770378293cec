#include "platform/base/latest_value.hpp"

#include <gtest/gtest.h>

namespace gannet {
namespace {

TEST(LatestValue, begins_with_the_first_value) {
  LatestValue<int> sut(7);
  EXPECT_FALSE(sut.fresh());
  EXPECT_EQ(sut.read(), 7);
}

TEST(LatestValue, reads_the_newest_and_only_it) {
  LatestValue<int> sut;
  for (int i = 1; i <= 10; ++i) sut.write(i);
  EXPECT_TRUE(sut.fresh());
  EXPECT_EQ(sut.read(), 10);
  EXPECT_FALSE(sut.fresh());
  EXPECT_EQ(sut.read(), 10);
}

TEST(LatestValue, keeps_what_the_reader_holds_while_the_writer_goes_on) {
  LatestValue<int> sut;
  sut.write(1);
  const int& held = sut.read();
  for (int i = 2; i < 20; ++i) sut.write(i);
  EXPECT_EQ(held, 1);
  EXPECT_EQ(sut.read(), 19);
}

TEST(LatestValue, can_be_filled_in_place) {
  LatestValue<std::pair<int, int>> sut;
  sut.back().first = 3;
  sut.back().second = 4;
  sut.publish();
  EXPECT_EQ(sut.read(), std::make_pair(3, 4));
}

}  // namespace
}  // namespace gannet
