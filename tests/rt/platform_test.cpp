// Proofs of the real-time rules for the pieces of the platform: 10,000 cycles of each.
#include <gtest/gtest.h>

#include <atomic>

#include "platform/base/event.hpp"
#include "platform/base/latest_value.hpp"
#include "platform/base/lease_pool.hpp"
#include "platform/base/ring.hpp"
#include "platform/base/stage_timer.hpp"
#include "platform/linux/clock.hpp"
#include "platform/linux/periodic.hpp"
#include "platform/linux/thread.hpp"
#include "platform/linux/worker_pool.hpp"
#include "tests/rt/rt_trap.hpp"
#include "tests/rt/rt_usage.hpp"

namespace gannet::linux_os {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr int kCycles = 10000;

TEST(RtPlatform, containers_take_no_heap_and_no_page_fault_after_warm_up) {
  SpscRing<Event> ring(64);
  EventPort port(16);
  LatestValue<std::array<StageStats, 2>> latest;
  LeasePool pool(8);
  StageTimer<2> timer;
  const auto cycle = [&] {
    timer.begin(monotonic_now());
    Lease lease = pool.lend();
    ring.push(Event{});
    port.raise({});
    Event event;
    ring.pop(event);
    port.take(event);
    timer.lap(0, monotonic_now());
    latest.write(timer.stages());
    static_cast<void>(latest.read());
    timer.lap(1, monotonic_now());
  };
  for (int i = 0; i < 10; ++i) cycle();
  const int trapped = test::trapped_calls();
  const test::RtUsage before = test::RtUsage::now();
  {
    const test::RtSection section;
    for (int i = 0; i < kCycles; ++i) cycle();
  }
  const test::RtUsage used = test::RtUsage::now().since(before);
  EXPECT_EQ(test::trapped_calls() - trapped, 0);
  if (test::kCountsPageFaults) {
    EXPECT_EQ(used.page_faults, 0);
  }
}

TEST(RtPlatform, a_periodic_loop_sleeps_once_a_cycle) {
  constexpr int kPeriods = 1000;
  test::RtUsage used;
  int trapped = 0;
  auto thread = Thread::start("periodic", {.priority = 50}, [&] {
    Periodic sut(monotonic_now() + milliseconds(1), microseconds(500));
    sut.wait();
    const int before_trap = test::trapped_calls();
    const test::RtUsage before = test::RtUsage::now();
    {
      const test::RtSection section;
      for (int i = 0; i < kPeriods; ++i) sut.wait();
    }
    used = test::RtUsage::now().since(before);
    trapped = test::trapped_calls() - before_trap;
  });
  ASSERT_TRUE(thread);
  thread->join();
  EXPECT_LE(used.voluntary_switches, kPeriods);
  if (test::kCountsPageFaults) {
    EXPECT_EQ(used.page_faults, 0);
  }
  EXPECT_EQ(trapped, 0);
}

TEST(RtPlatform, an_overrun_skips_periods_and_never_bursts) {
  Periodic sut(monotonic_now(), milliseconds(2));
  sut.wait();
  const TimePoint begin = monotonic_now();
  while (monotonic_now() < begin + milliseconds(9)) {
  }
  const auto late = sut.wait();
  EXPECT_GE(late.missed, 3);
  EXPECT_EQ(sut.overruns(), static_cast<std::uint64_t>(late.missed));
  const auto next = sut.wait();
  EXPECT_EQ((next.due - late.due) % milliseconds(2), Duration{});
  EXPECT_GT(next.due, late.due);
}

TEST(RtPlatform, the_pool_hands_over_without_heap_and_with_bounded_sleeps) {
  auto sut = WorkerPool::create("pool", {{}});
  ASSERT_TRUE(sut);
  std::atomic<int> work_done{0};
  const auto job = [&](int, int) {
    const test::RtSection section;
    work_done.fetch_add(1);
  };
  (*sut)->for_each(4, job);
  work_done = 0;
  const int trapped = test::trapped_calls();
  const test::RtUsage before = test::RtUsage::now();
  {
    const test::RtSection section;
    for (int i = 0; i < kCycles; ++i) (*sut)->for_each(4, job);
  }
  const test::RtUsage used = test::RtUsage::now().since(before);
  EXPECT_EQ(work_done, 4 * kCycles);
  EXPECT_EQ(test::trapped_calls() - trapped, 0);
  // The caller sleeps at most once for each hand-over.
  EXPECT_LE(used.voluntary_switches, kCycles);
  if (test::kCountsPageFaults) {
    EXPECT_EQ(used.page_faults, 0);
  }
}

}  // namespace
}  // namespace gannet::linux_os
