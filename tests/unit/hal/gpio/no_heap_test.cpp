#include <gtest/gtest.h>

#include "hal/gpio/simulated_line.hpp"
#include "tests/support/count_heap.hpp"
#include "tests/support/temporary_folder.hpp"

namespace gannet::hal {
namespace {

constexpr TimePoint at_ms(std::int64_t ms) { return TimePoint(std::chrono::milliseconds(ms)); }

TEST(GpioNoHeap, ReadingWritingLosingAndFindingLinesTakesNoMemory) {
  if (!test::kCountsHeap) GTEST_SKIP() << "the sanitizer has its own heap";
  const test::TemporaryFolder folder;
  SimulatedInput input(folder / "lines", "estop");
  SimulatedOutput output(folder / "lines", "light");
  std::uint64_t calls = 0;
  const auto cycles = [&](int from_ms) {
    const std::uint64_t before = test::heap_calls;
    for (int ms = from_ms; ms < from_ms + 2000; ms += 5) {
      input.read(at_ms(ms));
      output.write(ms % 2 == 0, at_ms(ms));
    }
    calls += test::heap_calls - before;
  };
  cycles(0);
  {
    auto world = std::move(SimulatedLines::create(folder / "lines", {"estop", "light"})).value();
    world.write(0, Level::kHigh, at_ms(2000));
    cycles(3000);
    EXPECT_EQ(input.read(at_ms(5000)).level, Level::kHigh);
  }
  cycles(6000);
  EXPECT_EQ(input.read(at_ms(8000)).level, Level::kUnknown);
  EXPECT_EQ(calls, 0u);
}

}  // namespace
}  // namespace gannet::hal
