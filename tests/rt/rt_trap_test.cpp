#include "tests/rt/rt_trap.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace gannet::test {
namespace {

TEST(RtTrap, catches_every_way_to_the_heap_and_only_inside_a_section) {
  if (!trap_works()) GTEST_SKIP() << "a sanitizer has its own malloc";
  const int before = trapped_calls();
  auto outside = std::vector<int>(100);
  EXPECT_EQ(trapped_calls(), before);
  int after_new = 0;
  {
    const RtSection section;
    auto inside = std::string(100, 'x');  // new
    after_new = trapped_calls();
    inside.shrink_to_fit();
    void* volatile memory = std::malloc(3);
    std::free(memory);
    memory = std::calloc(2, 2);
    std::free(memory);
  }
  EXPECT_EQ(after_new, before + 1);
  EXPECT_GE(trapped_calls(), before + 5);
  const int end = trapped_calls();
  outside.resize(10000);
  EXPECT_EQ(trapped_calls(), end);
}

}  // namespace
}  // namespace gannet::test
