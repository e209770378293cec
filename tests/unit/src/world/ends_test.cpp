#include "src/world/ends.hpp"

#include <gtest/gtest.h>

#include "src/config/daemon_config.hpp"
#include "src/world/deeds.hpp"

namespace gannet::world {
namespace {

TEST(Ends, are_the_runs_own_without_a_word) {
  const auto sut = parse_ends("", "", "");
  ASSERT_TRUE(sut);
  EXPECT_FALSE(sut->any_real());
}

TEST(Ends, read_the_kernels_interfaces) {
  const auto sut = parse_ends("v4l2:/dev/video10,/dev/video11", "socketcan:vcan0", "gpio-sim:/s/c");
  ASSERT_TRUE(sut);
  EXPECT_EQ(sut->video[0], "/dev/video10");
  EXPECT_EQ(sut->video[1], "/dev/video11");
  EXPECT_EQ(sut->can_interface, "vcan0");
  EXPECT_EQ(sut->gpio_folder, "/s/c");
}

TEST(Ends, refuse_another_form) {
  EXPECT_FALSE(parse_ends("v4l2:/dev/video10", "", ""));
  EXPECT_FALSE(parse_ends("v4l2:,/dev/video10", "", ""));
  EXPECT_FALSE(parse_ends("/dev/video10,/dev/video11", "", ""));
  EXPECT_FALSE(parse_ends("", "socketcan:", ""));
  EXPECT_FALSE(parse_ends("", "vcan0", ""));
  const auto lines = parse_ends("", "", "gpiod:0");
  ASSERT_FALSE(lines);
  EXPECT_NE(lines.error().text.find("gpio-sim:DIR"), std::string::npos);
}

TEST(Ends, tell_the_daemon_which_devices_to_open) {
  Scenario scenario;
  scenario.camera.width = 320;
  scenario.camera.height = 240;
  scenario.camera.fps = 15;
  config::DaemonConfig config;
  configure_ends(*parse_ends("v4l2:/dev/video10,/dev/video11", "socketcan:vcan1", ""), scenario,
                 config);
  EXPECT_EQ(config.camera.kind, "v4l2_pair");
  EXPECT_EQ(config.camera.v4l2_pair.right, "/dev/video11");
  EXPECT_EQ(config.camera.v4l2_pair.stream.width, 320);
  EXPECT_EQ(config.camera.v4l2_pair.stream.rate_hz, 15);
  EXPECT_EQ(config.can.kind, "socketcan");
  EXPECT_EQ(config.can.interface, "vcan1");
}

TEST(Deeds, what_the_cameras_cannot_play_is_refused_by_name) {
  Scenario scenario;
  for (const char* text : {"blind", "short frames", "skew left 15", "flag frames"})
    scenario.events.push_back({1, text, *parse_action(text)});
  const auto shared = check_events(scenario, {});
  ASSERT_FALSE(shared);
  EXPECT_EQ(shared.error().text.find("'blind'"), std::string::npos);
  for (const char* text : {"'short frames'", "'skew left 15'", "'flag frames'"})
    EXPECT_NE(shared.error().text.find(text), std::string::npos);
  scenario.events.pop_back();
  EXPECT_TRUE(check_events(scenario, {.short_frames = true, .two_stamps = true}));
}

}  // namespace
}  // namespace gannet::world
