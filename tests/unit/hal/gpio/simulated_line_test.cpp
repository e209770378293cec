#include "hal/gpio/simulated_line.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <optional>

#include "tests/support/temporary_folder.hpp"

namespace gannet::hal {
namespace {

constexpr TimePoint at_ms(std::int64_t ms) { return TimePoint(std::chrono::milliseconds(ms)); }

class SimulatedLineTest : public testing::Test {
 protected:
  void start_world() {
    world_.reset();
    auto made = SimulatedLines::create(path_, {"estop", "release", "light"});
    ASSERT_TRUE(made) << made.error().text;
    world_.emplace(std::move(*made));
  }
  static Level level(DigitalInput& input, std::int64_t ms) { return input.read(at_ms(ms)).level; }

  const test::TemporaryFolder folder_;
  const std::string path_ = folder_ / "lines";
  std::optional<SimulatedLines> world_;
};

TEST_F(SimulatedLineTest, AnInputFollowsTheWorld) {
  start_world();
  SimulatedInput sut(path_, "estop");
  EXPECT_EQ(level(sut, 0), Level::kUnknown);  // the world has not spoken yet
  world_->write(0, Level::kLow, at_ms(1));
  EXPECT_EQ(level(sut, 2), Level::kLow);
  world_->write(0, Level::kHigh, at_ms(3));
  const auto reading = sut.read(at_ms(4));
  EXPECT_EQ(reading.level, Level::kHigh);
  EXPECT_TRUE(reading.rose);
  EXPECT_FALSE(reading.fell);
  EXPECT_EQ(reading.edge_time, at_ms(3));
  EXPECT_FALSE(sut.read(at_ms(5)).rose);
}

TEST_F(SimulatedLineTest, APressBetweenTwoReadsIsSeen) {
  start_world();
  SimulatedInput sut(path_, "estop");
  world_->write(0, Level::kLow, at_ms(0));
  sut.read(at_ms(1));
  world_->write(0, Level::kHigh, at_ms(2));
  world_->write(0, Level::kLow, at_ms(3));
  const auto reading = sut.read(at_ms(4));
  EXPECT_EQ(reading.level, Level::kLow);
  EXPECT_TRUE(reading.rose);
  EXPECT_TRUE(reading.fell);
  EXPECT_EQ(reading.edge_time, at_ms(3));
}

TEST_F(SimulatedLineTest, EdgesBeforeTheFirstReadAreNobodys) {
  start_world();
  world_->write(0, Level::kLow, at_ms(0));
  world_->write(0, Level::kHigh, at_ms(0));
  SimulatedInput sut(path_, "estop");
  const auto reading = sut.read(at_ms(1));
  EXPECT_EQ(reading.level, Level::kHigh);
  EXPECT_FALSE(reading.rose);
}

TEST_F(SimulatedLineTest, WritingTheSameLevelIsNoEdge) {
  start_world();
  SimulatedOutput sut(path_, "release");
  EXPECT_EQ(world_->read(1), Level::kUnknown);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(sut.write(true, at_ms(i)));
  EXPECT_EQ(world_->read(1), Level::kHigh);
  EXPECT_EQ(world_->rises(1), 1u);
  sut.write(false, at_ms(6));
  sut.write(true, at_ms(7));
  EXPECT_EQ(world_->rises(1), 2u);
}

TEST_F(SimulatedLineTest, WithoutAFileALineIsUnknownAndFoundASecondLater) {
  SimulatedInput sut(path_, "estop");
  SimulatedOutput output(path_, "light");
  EXPECT_EQ(level(sut, 0), Level::kUnknown);
  EXPECT_FALSE(output.write(true, at_ms(0)));
  start_world();
  world_->write(0, Level::kHigh, at_ms(1));
  EXPECT_EQ(level(sut, 999), Level::kUnknown);
  EXPECT_EQ(level(sut, 1000), Level::kHigh);
  EXPECT_TRUE(output.write(true, at_ms(1000)));
}

TEST_F(SimulatedLineTest, AWorldThatEndsLeavesTheLineUnknownAndANewOneIsFound) {
  start_world();
  world_->write(0, Level::kLow, at_ms(0));
  SimulatedInput sut(path_, "estop");
  EXPECT_EQ(level(sut, 1), Level::kLow);
  world_.reset();
  EXPECT_EQ(level(sut, 2), Level::kUnknown);
  start_world();
  world_->write(0, Level::kHigh, at_ms(3));
  const auto reading = sut.read(at_ms(2000));
  EXPECT_EQ(reading.level, Level::kHigh);
  EXPECT_FALSE(reading.rose);  // another file's count is not comparable
}

TEST_F(SimulatedLineTest, AWorldThatReplacesADeadOnesFileIsNoticed) {
  start_world();
  world_->write(0, Level::kLow, at_ms(0));
  SimulatedInput sut(path_, "estop");
  EXPECT_EQ(level(sut, 0), Level::kLow);
  auto second = SimulatedLines::create(path_, {"estop"});  // while the first never said farewell
  ASSERT_TRUE(second);
  second->write(0, Level::kHigh, at_ms(1));
  EXPECT_EQ(level(sut, 2), Level::kUnknown);
  EXPECT_EQ(level(sut, 1002), Level::kHigh);
}

TEST_F(SimulatedLineTest, AnUnknownNameIsUnknown) {
  start_world();
  SimulatedInput sut(path_, "horn");
  EXPECT_EQ(level(sut, 0), Level::kUnknown);
}

TEST_F(SimulatedLineTest, ADamagedFileIsUnknown) {
  start_world();
  std::string good(64 + 3 * 64, '\0');
  std::ifstream(path_, std::ios::binary)
      .read(good.data(), static_cast<std::streamsize>(good.size()));
  world_.reset();
  int tried = 0;
  const auto level_of = [&](const std::string& bytes) {
    const std::string path = path_ + std::to_string(tried++);
    std::ofstream(path, std::ios::binary) << bytes;
    SimulatedInput sut(path, "estop");
    return level(sut, 0);
  };
  const auto with = [&](std::size_t at, char value) {
    std::string bytes = good;
    bytes[at] = value;
    return bytes;
  };
  EXPECT_EQ(level_of(with(64 + 40, 1)), Level::kHigh);      // the untouched way works
  EXPECT_EQ(level_of(with(0, 'X')), Level::kUnknown);       // magic
  EXPECT_EQ(level_of(with(8, 2)), Level::kUnknown);         // format
  EXPECT_EQ(level_of(with(15, 1)), Level::kUnknown);        // more lines than bytes
  EXPECT_EQ(level_of(with(64 + 40, 77)), Level::kUnknown);  // no level
  EXPECT_EQ(level_of(good.substr(0, 100)), Level::kUnknown);
  EXPECT_EQ(level_of(good.substr(0, 10)), Level::kUnknown);
  EXPECT_EQ(level_of(""), Level::kUnknown);
}

TEST_F(SimulatedLineTest, NamesAreCheckedWhenCreated) {
  EXPECT_FALSE(SimulatedLines::create(path_, {""}));
  EXPECT_FALSE(SimulatedLines::create(path_, {std::string(40, 'x')}));
  EXPECT_FALSE(SimulatedLines::create(path_, {"a", "b", "a"}));
  EXPECT_FALSE(SimulatedLines::create(folder_ / "nowhere/lines", {"a"}));
  start_world();
  EXPECT_EQ(world_->find("light"), 2);
  EXPECT_EQ(world_->find("lights"), -1);
}

}  // namespace
}  // namespace gannet::hal
