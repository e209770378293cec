#include "platform/base/ring.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace gannet {
namespace {

TEST(SpscRing, gives_back_in_order) {
  SpscRing<int> sut(8);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(sut.push(i));
  EXPECT_EQ(sut.size(), 5);
  int value = -1;
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(sut.pop(value));
    EXPECT_EQ(value, i);
  }
  EXPECT_FALSE(sut.pop(value));
  EXPECT_EQ(value, 4);
}

TEST(SpscRing, refuses_when_full_and_leaves_the_value) {
  SpscRing<std::unique_ptr<int>> sut(2);
  EXPECT_TRUE(sut.push(std::make_unique<int>(1)));
  EXPECT_TRUE(sut.push(std::make_unique<int>(2)));
  auto third = std::make_unique<int>(3);
  EXPECT_FALSE(sut.push(std::move(third)));
  ASSERT_NE(third, nullptr);
  std::unique_ptr<int> out;
  EXPECT_TRUE(sut.pop(out));
  EXPECT_TRUE(sut.push(std::move(third)));
  EXPECT_EQ(third, nullptr);
}

TEST(SpscRing, holds_its_capacity_at_every_phase_of_the_indices) {
  SpscRing<int> sut(4);
  int value = 0;
  for (int round = 0; round < 13; ++round) {
    for (int i = 0; i < sut.capacity(); ++i) EXPECT_TRUE(sut.push(i));
    EXPECT_FALSE(sut.push(99));
    for (int i = 0; i < sut.capacity(); ++i) EXPECT_TRUE(sut.pop(value));
    EXPECT_TRUE(sut.push(0));
    EXPECT_TRUE(sut.pop(value));
  }
}

TEST(SpscRing, rounds_the_capacity_up) {
  EXPECT_EQ(SpscRing<int>(5).capacity(), 8);
  EXPECT_EQ(SpscRing<int>(1).capacity(), 1);
}

TEST(SpscRing, drops_its_elements_with_itself) {
  auto counted = std::make_shared<int>(0);
  {
    SpscRing<std::shared_ptr<int>> sut(4);
    sut.push(counted);
    EXPECT_EQ(counted.use_count(), 2);
  }
  EXPECT_EQ(counted.use_count(), 1);
}

}  // namespace
}  // namespace gannet
