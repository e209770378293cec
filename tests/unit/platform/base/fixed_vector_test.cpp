#include "platform/base/fixed_vector.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace gannet {
namespace {

TEST(FixedVector, refuses_more_than_it_holds) {
  FixedVector<int, 3> sut;
  EXPECT_TRUE(sut.push_back(1));
  EXPECT_TRUE(sut.push_back(2));
  EXPECT_TRUE(sut.push_back(3));
  EXPECT_TRUE(sut.full());
  EXPECT_FALSE(sut.push_back(4));
  EXPECT_EQ(std::accumulate(sut.begin(), sut.end(), 0), 6);
}

TEST(FixedVector, is_empty_after_clear_and_shorter_after_truncate) {
  FixedVector<int, 4> sut;
  for (int i = 0; i < 4; ++i) sut.push_back(i);
  sut.truncate(2);
  EXPECT_EQ(sut.size(), 2);
  EXPECT_EQ(sut.span().size(), 2u);
  EXPECT_EQ(sut[1], 1);
  sut.clear();
  EXPECT_TRUE(sut.empty());
}

}  // namespace
}  // namespace gannet
