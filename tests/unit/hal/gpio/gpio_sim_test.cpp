// GpiodInput and GpiodOutput on the real kernel: where its simulated chip can be made (root, module
// gpio-sim, configfs), else skipped. Written to configfs and sysfs as the kernel's documentation of
// gpio-sim says.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "hal/gpio/gpiod_line.hpp"
#include "hal/gpio/line_kinds.hpp"
#include "platform/linux/clock.hpp"

namespace gannet::hal {
namespace {

namespace fs = std::filesystem;
using linux_os::monotonic_now;

class GpioSimTest : public testing::Test {
 protected:
  void SetUp() override {
    std::error_code error;
    const fs::path all = "/sys/kernel/config/gpio-sim";
    if (!fs::exists(all, error)) GTEST_SKIP() << "no gpio-sim here";
    chip_ = all / ("gannet" + std::to_string(getpid()));
    const fs::path bank = chip_ / "bank0";
    if (!fs::create_directory(chip_, error) || !fs::create_directory(bank, error)) {
      GTEST_SKIP() << "no chip can be made here";
    }
    write(bank / "num_lines", "8");
    write(bank / "label", label_);
    fs::create_directory(bank / "line3", error);
    write(bank / "line3/name", "ESTOP");
    write(chip_ / "live", "1");
    const std::string node = read(bank / "chip_name");
    lines_ = fs::path("/sys/devices/platform") / read(chip_ / "dev_name") / node;
    device_ = "/dev/" + node;
    for (int i = 0; i < 100 && !fs::exists(device_, error); ++i) wait();
  }
  // No line is held any more: the kernel does not bear that.
  void TearDown() override {
    if (chip_.empty()) return;
    std::error_code error;
    write(chip_ / "live", "0");
    for (const char* folder : {"bank0/line3", "bank0", ""}) fs::remove(chip_ / folder, error);
  }

  static void write(const fs::path& file, const std::string& text) {
    std::ofstream(file) << text << std::flush;
  }
  static std::string read(const fs::path& file) {
    std::string word;
    std::ifstream(file) >> word;
    return word;
  }
  static void wait() { std::this_thread::sleep_for(std::chrono::milliseconds(10)); }
  void pull(int line, bool up) {
    write(lines_ / ("sim_gpio" + std::to_string(line)) / "pull", up ? "pull-up" : "pull-down");
    wait();
  }
  std::string driven(int line) {
    return read(lines_ / ("sim_gpio" + std::to_string(line)) / "value");
  }
  LineConfig config(const std::string& chip, const std::string& line) const {
    LineConfig config;
    config.kind = "gpiod";
    config.chip = chip;
    config.line = line;
    return config;
  }

  const std::string label_ = "gannet-test-" + std::to_string(getpid());
  fs::path chip_, lines_;
  std::string device_;
};

TEST_F(GpioSimTest, AnInputTellsLevelsEdgesAndTimes) {
  for (const std::string& chip : {label_, device_, fs::path(device_).filename().string()}) {
    pull(3, false);
    const auto line = std::move(*make_input(config(chip, "ESTOP")));
    auto reading = line->read(monotonic_now());
    EXPECT_EQ(reading.level, Level::kLow) << chip;
    EXPECT_FALSE(reading.rose || reading.fell);
    const TimePoint before = monotonic_now();
    pull(3, true);
    reading = line->read(monotonic_now());
    EXPECT_EQ(reading.level, Level::kHigh);
    EXPECT_TRUE(reading.rose);
    EXPECT_FALSE(reading.fell);
    EXPECT_GE(reading.edge_time, before);
    EXPECT_LE(reading.edge_time, monotonic_now());
    pull(3, false);
    pull(3, true);
    pull(3, false);
    reading = line->read(monotonic_now());
    EXPECT_EQ(reading.level, Level::kLow);
    EXPECT_TRUE(reading.rose && reading.fell) << "a press between two reads";
    reading = line->read(monotonic_now());
    EXPECT_FALSE(reading.rose || reading.fell) << "without waiting for one";
  }
}

TEST_F(GpioSimTest, AnOutputIsDrivenFromItsFirstMomentAndLeftInactive) {
  LineConfig lamp = config(label_, "5");
  auto line = std::move(*make_output(lamp));
  EXPECT_EQ(driven(5), "0");
  EXPECT_TRUE(line->write(true, monotonic_now()));
  EXPECT_EQ(driven(5), "1");
  line.reset();
  EXPECT_EQ(driven(5), "0");
  lamp.active_low = true;
  line = std::move(*make_output(lamp));
  EXPECT_EQ(driven(5), "1");
  EXPECT_TRUE(line->write(true, monotonic_now()));
  EXPECT_EQ(driven(5), "0");
}

TEST_F(GpioSimTest, ALineIsTakenOnce) {
  const auto line = std::move(*make_input(config(label_, "ESTOP")));
  const auto second = make_input(config(label_, "3"));
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().text.find("gpioinfo"), std::string::npos) << second.error().text;
  EXPECT_FALSE(make_output(config(label_, "ESTOP")));
}

TEST_F(GpioSimTest, LinesThatAreNotThereAreRefused) {
  for (const char* name : {"NO_SUCH_LINE", "8", "-1"}) {
    const auto line = make_input(config(label_, name));
    ASSERT_FALSE(line) << name;
    EXPECT_NE(line.error().text.find(name), std::string::npos) << line.error().text;
  }
}

TEST_F(GpioSimTest, APullIsAskedFor) {
  LineConfig pulled = config(label_, "6");
  pulled.bias = "pull_up";
  pull(6, false);
  const auto line = std::move(*make_input(pulled));
  EXPECT_EQ(line->read(monotonic_now()).level, Level::kHigh) << "gpio-sim takes it for the level";
}

}  // namespace
}  // namespace gannet::hal
