#include "platform/linux/worker_pool.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>

namespace gannet::linux_os {
namespace {

TEST(WorkerPool, does_each_piece_exactly_once) {
  auto sut = WorkerPool::create("test", {{}, {}});
  ASSERT_TRUE(sut);
  EXPECT_EQ((*sut)->workers(), 3);
  for (const int n : {0, 1, 2, 3, 7, 100, 1000}) {
    std::array<std::atomic<int>, 1000> times = {};
    (*sut)->for_each(n, [&](int index, int worker) {
      EXPECT_TRUE(worker >= 0 && worker < 3);
      times[static_cast<std::size_t>(index)] += 1;
    });
    for (int i = 0; i < 1000; ++i) {
      ASSERT_EQ(times[static_cast<std::size_t>(i)], i < n ? 1 : 0) << n << " " << i;
    }
  }
}

TEST(WorkerPool, helpers_really_help) {
  auto sut = WorkerPool::create("test", {{}});
  ASSERT_TRUE(sut);
  std::atomic<bool> helped = false;
  // The caller holds its piece until the other one was taken by somebody else.
  (*sut)->for_each(2, [&](int, int worker) {
    if (worker == 1) helped = true;
    while (!helped) sched_yield();
  });
  EXPECT_TRUE(helped);
}

TEST(WorkerPool, works_alone_without_helpers) {
  auto sut = WorkerPool::create("test", {});
  ASSERT_TRUE(sut);
  int sum = 0;
  (*sut)->for_each(10, [&](int index, int) { sum += index; });
  EXPECT_EQ(sum, 45);
}

}  // namespace
}  // namespace gannet::linux_os
