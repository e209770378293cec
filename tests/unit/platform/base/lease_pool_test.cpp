#include "platform/base/lease_pool.hpp"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace gannet {
namespace {

TEST(LeasePool, lends_each_slot_once) {
  for (const int slots : {1, 3, 64}) {
    LeasePool sut(slots);
    std::vector<Lease> out;
    std::set<int> seen;
    for (int i = 0; i < slots; ++i) {
      out.push_back(sut.lend());
      ASSERT_TRUE(out.back().valid());
      seen.insert(out.back().slot());
    }
    EXPECT_EQ(static_cast<int>(seen.size()), slots);
    EXPECT_FALSE(sut.lend().valid());
    out.clear();
    EXPECT_EQ(sut.free_count(), slots);
  }
}

TEST(LeasePool, a_moved_lease_comes_home_once) {
  LeasePool sut(2);
  {
    Lease a = sut.lend();
    Lease b = std::move(a);
    EXPECT_FALSE(a.valid());
    EXPECT_EQ(sut.free_count(), 1);
    b = sut.lend();  // the first one goes home as the second is taken over
    EXPECT_EQ(sut.free_count(), 1);
  }
  EXPECT_EQ(sut.free_count(), 2);
}

}  // namespace
}  // namespace gannet
