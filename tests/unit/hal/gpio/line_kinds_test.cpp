#include "hal/gpio/line_kinds.hpp"

#include <gtest/gtest.h>

#include "hal/gpio/simulated_line.hpp"
#include "tests/support/temporary_folder.hpp"

namespace gannet::hal {
namespace {

constexpr TimePoint at_ms(std::int64_t ms) { return TimePoint(std::chrono::milliseconds(ms)); }

TEST(LineKinds, ActiveLowTurnsLevelsAndEdgesRound) {
  const test::TemporaryFolder folder;
  auto world = std::move(SimulatedLines::create(folder / "lines", {"estop", "light"})).value();
  LineConfig config = {
      .kind = "simulated", .path = folder / "lines", .name = "estop", .active_low = true};
  world.write(0, Level::kHigh, at_ms(0));
  auto input = std::move(*make_input(config));
  EXPECT_EQ(input->read(at_ms(1)).level, Level::kLow);
  world.write(0, Level::kLow, at_ms(2));
  const auto reading = input->read(at_ms(3));
  EXPECT_EQ(reading.level, Level::kHigh);
  EXPECT_TRUE(reading.rose);
  EXPECT_FALSE(reading.fell);
  world.write(0, Level::kUnknown, at_ms(4));
  EXPECT_EQ(input->read(at_ms(5)).level, Level::kUnknown);
  config.name = "light";
  auto output = std::move(*make_output(config));
  EXPECT_TRUE(output->write(true, at_ms(6)));
  EXPECT_EQ(world.read(1), Level::kLow);
}

TEST(LineKinds, AnOutputIsLeftInactive) {
  const test::TemporaryFolder folder;
  auto world = std::move(SimulatedLines::create(folder / "lines", {"light", "relay"})).value();
  LineConfig config = {.kind = "simulated", .path = folder / "lines", .name = "light"};
  auto light = std::move(*make_output(config));
  config.name = "relay";
  config.active_low = true;
  auto relay = std::move(*make_output(config));
  light->write(true, at_ms(1));
  relay->write(true, at_ms(1));
  EXPECT_EQ(world.read(0), Level::kHigh);
  EXPECT_EQ(world.read(1), Level::kLow);
  light.reset();
  relay.reset();
  EXPECT_EQ(world.read(0), Level::kLow);
  EXPECT_EQ(world.read(1), Level::kHigh);
}

TEST(LineKinds, ALineThatIsNotFittedIsInactive) {
  auto input = std::move(*make_input({}));
  EXPECT_EQ(input->read(at_ms(0)).level, Level::kLow);
  auto output = std::move(*make_output({}));
  EXPECT_TRUE(output->write(true, at_ms(0)));
}

TEST(LineKinds, KindsThatAreWrongAreRefused) {
  const auto unknown = make_input({.kind = "semaphore", .path = "a", .name = "b"});
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().text.find("none, gpiod, simulated"), std::string::npos);
  EXPECT_FALSE(make_output({.kind = "simulated", .path = "", .name = "b"}));
  EXPECT_FALSE(make_output({.kind = "simulated", .path = "a", .name = ""}));
  EXPECT_FALSE(make_input({.kind = "gpiod", .chip = "/dev/gpiochip0", .line = ""}));
  EXPECT_FALSE(make_input({.kind = "gpiod", .chip = "", .line = "4"}));
}

}  // namespace
}  // namespace gannet::hal
