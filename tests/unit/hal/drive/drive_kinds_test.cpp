#include "hal/drive/drive_kinds.hpp"

#include <gtest/gtest.h>

namespace gannet::hal {
namespace {

DriveConfig with_motors(int motors) {
  DriveConfig config;
  for (int i = 0; i < motors; ++i) config.motors.push_back({.index = i, .node_id = 21 + i});
  return config;
}

TEST(DriveKinds, RefusesAConfigThatDoesNotFitTogether) {
  const auto refused = [](auto&& change, const char* why) {
    DriveConfig config = with_motors(2);
    change(config);
    const auto made = make_drive_group(config);
    ASSERT_FALSE(made) << why;
    EXPECT_NE(made.error().text.find(why), std::string::npos) << made.error().text;
  };
  refused([](DriveConfig& c) { c.kind = "steam"; }, "dronecan_esc");
  refused([](DriveConfig& c) { c.motors.clear(); }, "no motor");
  refused([](DriveConfig& c) { c.motors[1].index = 0; }, "also that of motor 1");
  refused([](DriveConfig& c) { c.motors[1].index = 20; }, "0 to 19");
  refused([](DriveConfig& c) { c.motors[1].node_id = 10; }, "own_node_id");
  refused([](DriveConfig& c) { c.motors[1].node_id = 128; }, "1 to 127");
  refused([](DriveConfig& c) { c.own_node_id = 0; }, "1 to 127");
  refused([](DriveConfig& c) { c.range = "sideways"; }, "sideways");
  refused([](DriveConfig& c) { c.motors[0].pole_pairs = 0; }, "pole_pairs");
}

TEST(DriveKinds, MakesTheKindWithItsMotors) {
  const auto group = make_drive_group(with_motors(6));
  ASSERT_TRUE(group);
  EXPECT_EQ((*group)->size(), 6);
}

}  // namespace
}  // namespace gannet::hal
