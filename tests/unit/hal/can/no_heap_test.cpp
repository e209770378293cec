#include <gtest/gtest.h>

#include "hal/can/local_bus.hpp"
#include "hal/can/memory_bus.hpp"
#include "tests/support/count_heap.hpp"
#include "tests/support/temporary_folder.hpp"

namespace gannet::hal {
namespace {

constexpr TimePoint at_ms(std::int64_t ms) { return TimePoint(std::chrono::milliseconds(ms)); }

std::uint64_t heap_calls_of_cycles(CanBus& a, CanBus& b, int from_ms) {
  const CanFrame frame = {.id = 1, .extended = true};
  ReceivedCanFrame in[4];
  const std::uint64_t before = test::heap_calls;
  for (int ms = from_ms; ms < from_ms + 1000; ++ms) {
    a.send({&frame, 1}, at_ms(ms));
    b.receive(in, at_ms(ms));
  }
  return test::heap_calls - before;
}

TEST(CanNoHeap, SendAndReceiveTakeNoMemory) {
  if (!test::kCountsHeap) GTEST_SKIP() << "the sanitizer has its own heap";
  MemoryWire wire(2);
  EXPECT_EQ(heap_calls_of_cycles(wire.port(0), wire.port(1), 0), 0u);
  auto [a, b] = std::move(LocalBus::pair()).value();
  EXPECT_EQ(heap_calls_of_cycles(*a, *b, 0), 0u);
}

TEST(CanNoHeap, LosingAndFindingAHubTakesNoMemory) {
  if (!test::kCountsHeap) GTEST_SKIP() << "the sanitizer has its own heap";
  const test::TemporaryFolder folder;
  auto node = std::move(LocalBus::connect(folder / "can0", at_ms(0))).value();
  EXPECT_EQ(heap_calls_of_cycles(*node, *node, 0), 0u);  // nobody there
  auto hub = std::move(LocalCanHub::listen(folder / "can0")).value();
  EXPECT_EQ(heap_calls_of_cycles(*node, *hub, 2000), 0u);
  EXPECT_EQ(node->connections(), 1u);
  EXPECT_GT(hub->counters().received, 0u);
  hub.reset();
  EXPECT_EQ(heap_calls_of_cycles(*node, *node, 4000), 0u);
  EXPECT_EQ(node->state(), BusState::kDown);
}

}  // namespace
}  // namespace gannet::hal
