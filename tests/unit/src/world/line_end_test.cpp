#include "src/world/line_end.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "hal/gpio/line_kinds.hpp"
#include "tests/support/temporary_folder.hpp"

namespace gannet::world {
namespace {

namespace fs = std::filesystem;
using hal::Level;

constexpr TimePoint kNow = time_from_ns(1'000'000'000);

TEST(SimulatedLineEnd, presses_both_contacts_of_the_daemons_own_lines) {
  const test::TemporaryFolder folder;
  const LineEndConfig config = {"simulated", folder / "lines", true};
  const auto sut = make_line_end(config);
  ASSERT_TRUE(sut) << sut.error().text;
  config::GpioConfig gpio;
  configure_lines(**sut, config, gpio);
  auto first = hal::make_input(gpio.estop);
  auto second = hal::make_input(gpio.estop_second);
  auto release = hal::make_output(gpio.release);
  ASSERT_TRUE(first && second && release);

  (*sut)->press(Button::kReleased, kNow);
  EXPECT_EQ((*first)->read(kNow).level, Level::kLow);
  EXPECT_EQ((*second)->read(kNow).level, Level::kLow);  // active_low turns it
  (*sut)->press(Button::kPressed, kNow);
  EXPECT_EQ((*first)->read(kNow).level, Level::kHigh);
  EXPECT_EQ((*second)->read(kNow).level, Level::kHigh);
  (*sut)->press(Button::kCut, kNow);
  EXPECT_EQ((*first)->read(kNow).level, Level::kUnknown);

  EXPECT_FALSE((*sut)->is_high(WorldLine::kRelease));
  (*release)->write(true, kNow);
  EXPECT_TRUE((*sut)->is_high(WorldLine::kRelease));
}

TEST(LineEnd, one_contact_needs_no_second_line) {
  const test::TemporaryFolder folder;
  const LineEndConfig config = {"simulated", folder / "lines", false};
  const auto sut = make_line_end(config);
  ASSERT_TRUE(sut);
  config::GpioConfig gpio;
  configure_lines(**sut, config, gpio);
  EXPECT_EQ(gpio.estop_second.kind, "none");
}

// Plain files in the place of those of the kernel's gpio-sim.
class GpioSimEnd : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int i = 0; i < 4; ++i) {
      const std::string line = chip() + "/sim_gpio" + std::to_string(i);
      fs::create_directories(line);
      std::ofstream(line + "/pull") << "pull-down\n";
      std::ofstream(line + "/value") << "0\n";
    }
  }
  std::string chip() const { return folder_ / "gpiochip7"; }
  std::string pull(int line) const {
    std::string text;
    std::getline(std::ifstream(chip() + "/sim_gpio" + std::to_string(line) + "/pull"), text);
    return text;
  }
  const test::TemporaryFolder folder_;
};

TEST_F(GpioSimEnd, pulls_inputs_and_reads_outputs) {
  const auto sut = make_line_end({"gpio-sim", chip(), true});
  ASSERT_TRUE(sut) << sut.error().text;
  EXPECT_EQ(pull(0), "pull-down");
  EXPECT_EQ(pull(1).substr(0, 7), "pull-up");
  (*sut)->press(Button::kPressed, kNow);
  EXPECT_EQ(pull(0).substr(0, 7), "pull-up");
  EXPECT_EQ(pull(1), "pull-down");
  (*sut)->press(Button::kCut, kNow);  // one wire: the contacts disagree
  EXPECT_EQ(pull(0).substr(0, 7), "pull-up");
  EXPECT_EQ(pull(1).substr(0, 7), "pull-up");

  EXPECT_FALSE((*sut)->is_high(WorldLine::kRelease));
  std::ofstream(chip() + "/sim_gpio2/value") << "1\n";
  EXPECT_TRUE((*sut)->is_high(WorldLine::kRelease));
}

TEST_F(GpioSimEnd, tells_the_daemon_the_chips_lines) {
  const LineEndConfig config = {"gpio-sim", chip(), true};
  const auto sut = make_line_end(config);
  ASSERT_TRUE(sut);
  config::GpioConfig gpio;
  configure_lines(**sut, config, gpio);
  EXPECT_EQ(gpio.estop.kind, "gpiod");
  EXPECT_EQ(gpio.estop.chip, "/dev/gpiochip7");
  EXPECT_EQ(gpio.estop.line, "0");
  EXPECT_EQ(gpio.estop.bias, "as_is");
  EXPECT_TRUE(gpio.estop_second.active_low);
  EXPECT_EQ(gpio.light.line, "3");
}

TEST_F(GpioSimEnd, says_which_line_is_missing) {
  fs::remove_all(chip() + "/sim_gpio3");
  const auto sut = make_line_end({"gpio-sim", chip(), true});
  ASSERT_FALSE(sut);
  EXPECT_NE(sut.error().text.find("sim_gpio3/value"), std::string::npos);
  EXPECT_FALSE(make_line_end({"gpio-sim", chip() + "/none", true}));
}

}  // namespace
}  // namespace gannet::world
