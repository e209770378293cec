#include "hal/gpio/gpiod_line.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <deque>

#include "hal/gpio/line_kinds.hpp"
#include "tests/support/heap_calls.hpp"

namespace gannet::hal {
namespace {

constexpr TimePoint at_ms(std::int64_t ms) { return TimePoint(std::chrono::milliseconds(ms)); }

// One line of a scripted kernel, which outlives whoever holds it.
struct Script {
  int level = 0;
  int error = 0;  // every call fails by it, as when the chip was unplugged
  std::deque<LineEdge> edges;
  std::vector<bool> written;
  int reads = 0;
  bool is_held = false;

  void edge(bool is_rising, std::int64_t ms) {
    level = is_rising ? 1 : 0;
    edges.push_back({is_rising, at_ms(ms)});
  }
};

class ScriptedLine final : public HeldLine {
 public:
  explicit ScriptedLine(Script& script) : script_(script) { script_.is_held = true; }
  ~ScriptedLine() override { script_.is_held = false; }
  int level() override { return script_.error != 0 ? -script_.error : script_.level; }
  int set_level(bool high) override {
    if (script_.error != 0) return -script_.error;
    script_.written.push_back(high);
    return 0;
  }
  int read_edges(std::span<LineEdge> edges) override {
    ++script_.reads;
    if (script_.error != 0) return -script_.error;
    std::size_t n = 0;
    for (; n < edges.size() && !script_.edges.empty(); ++n) {
      edges[n] = script_.edges.front();
      script_.edges.pop_front();
    }
    return static_cast<int>(n);
  }

 private:
  Script& script_;
};

class ScriptedGpio final : public GpioCalls {
 public:
  Result<std::unique_ptr<HeldLine>> hold(const LineRequest& asked) override {
    request = asked;
    if (refusal != 0) return line_error(asked, "taking the line", refusal);
    return std::unique_ptr<HeldLine>(new ScriptedLine(script));
  }
  Script script;
  LineRequest request;
  int refusal = 0;
};

const LineConfig kConfig = {
    .kind = "gpiod", .chip = "pinctrl", .line = "ESTOP", .bias = "pull_up", .active_low = true};

TEST(GpiodInput, AsksForTheLineAndItsPull) {
  ScriptedGpio gpio;
  const auto line = std::move(*GpiodInput::open(kConfig, gpio));
  EXPECT_EQ(gpio.request.chip, "pinctrl");
  EXPECT_EQ(gpio.request.line, "ESTOP");
  EXPECT_EQ(gpio.request.bias, Bias::kPullUp);
  EXPECT_FALSE(gpio.request.is_output);
}

TEST(GpiodInput, TellsLevelAndEdgesOfEveryCycle) {
  ScriptedGpio gpio;
  const auto line = std::move(*GpiodInput::open(kConfig, gpio));
  EXPECT_EQ(line->read(at_ms(5)).level, Level::kLow);
  gpio.script.edge(true, 7);
  auto reading = line->read(at_ms(10));
  EXPECT_EQ(reading.level, Level::kHigh);
  EXPECT_TRUE(reading.rose);
  EXPECT_FALSE(reading.fell);
  EXPECT_EQ(reading.edge_time, at_ms(7));
  reading = line->read(at_ms(15));
  EXPECT_EQ(reading.level, Level::kHigh);
  EXPECT_FALSE(reading.rose);
}

TEST(GpiodInput, APressBetweenTwoCyclesIsSeen) {
  ScriptedGpio gpio;
  const auto line = std::move(*GpiodInput::open(kConfig, gpio));
  gpio.script.edge(true, 6);
  gpio.script.edge(false, 7);
  const auto reading = line->read(at_ms(10));
  EXPECT_EQ(reading.level, Level::kLow);
  EXPECT_TRUE(reading.rose && reading.fell);
  EXPECT_EQ(reading.edge_time, at_ms(7));
}

TEST(GpiodInput, AFlutteringLineDoesNotHoldTheCall) {
  ScriptedGpio gpio;
  const auto line = std::move(*GpiodInput::open(kConfig, gpio));
  for (int i = 0; i < 1000; ++i) gpio.script.edge(i % 2 == 0, i);
  EXPECT_TRUE(line->read(at_ms(2000)).rose);
  EXPECT_LE(gpio.script.reads, 4);
}

TEST(GpiodInput, AnUnpluggedChipIsUnknown) {
  ScriptedGpio gpio;
  const auto line = std::move(*GpiodInput::open(kConfig, gpio));
  gpio.script.error = ENODEV;
  EXPECT_EQ(line->read(at_ms(5)).level, Level::kUnknown);
}

TEST(GpiodInput, ALineThatIsTakenIsRefusedByName) {
  ScriptedGpio gpio;
  gpio.refusal = EBUSY;
  const auto line = GpiodInput::open(kConfig, gpio);
  ASSERT_FALSE(line);
  EXPECT_NE(line.error().text.find("ESTOP"), std::string::npos) << line.error().text;
  EXPECT_NE(line.error().text.find("gpioinfo"), std::string::npos) << line.error().text;
}

TEST(GpiodInput, TheRealKernelRefusesAChipThatIsNotThere) {
  LineConfig config = kConfig;
  for (const char* chip : {"/dev/gannet-no-such-chip", "gannet-no-such-label"}) {
    config.chip = chip;
    const auto line = make_input(config);
    ASSERT_FALSE(line);
    EXPECT_NE(line.error().text.find(chip), std::string::npos) << line.error().text;
    EXPECT_NE(line.error().text.find("gpiodetect"), std::string::npos) << line.error().text;
    EXPECT_FALSE(make_output(config));
  }
}

TEST(GpiodOutput, HasItsLevelFromTheFirstMoment) {
  ScriptedGpio gpio;
  const auto high = std::move(*GpiodOutput::open(kConfig, true, gpio));
  EXPECT_TRUE(gpio.request.is_output && gpio.request.high);
  const auto low = std::move(*GpiodOutput::open(kConfig, false, gpio));
  EXPECT_FALSE(gpio.request.high);
}

TEST(GpiodOutput, WritesAndSaysWhatIsRefused) {
  ScriptedGpio gpio;
  const auto line = std::move(*GpiodOutput::open(kConfig, false, gpio));
  EXPECT_TRUE(line->write(true, at_ms(1)));
  EXPECT_EQ(gpio.script.written, std::vector<bool>{true});
  gpio.script.error = EIO;
  EXPECT_FALSE(line->write(false, at_ms(2)));
}

TEST(GpiodLine, ReadingAndWritingTakeNoMemory) {
  if (!test::kCountsHeap) GTEST_SKIP() << "the sanitizer has its own heap";
  ScriptedGpio gpio;
  const auto input = std::move(*GpiodInput::open(kConfig, gpio));
  const std::uint64_t before = test::heap_calls;
  for (int ms = 0; ms < 100; ++ms) input->read(at_ms(ms));
  EXPECT_EQ(test::heap_calls, before);
}

TEST(GpiodLine, OffsetsAreWholeNumbers) {
  EXPECT_EQ(offset_from("17"), 17);
  for (const char* text : {"", "-1", "GPIO17", "17 ", "99999999999"}) {
    EXPECT_EQ(offset_from(text), -1) << text;
  }
}

}  // namespace
}  // namespace gannet::hal
