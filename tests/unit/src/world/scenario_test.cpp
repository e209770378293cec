#include "src/world/scenario.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

namespace gannet::world {
namespace {

class ScenarioFile : public ::testing::Test {
 protected:
  Result<Scenario> load(const std::string& text) {
    std::ofstream(path_) << text;
    return load_scenario(path_);
  }
  void TearDown() override { std::remove(path_.c_str()); }
  const std::string path_ = ::testing::TempDir() + "gannet_scenario_test.toml";
};

TEST(Scenarios, all_that_we_ship_load) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("tests/scenarios")) {
    if (entry.path().extension() != ".toml") continue;
    ++count;
    const auto scenario = load_scenario(entry.path().string());
    ASSERT_TRUE(scenario) << (scenario ? "" : scenario.error().text);
    EXPECT_FALSE(scenario->checks.empty()) << entry.path();
    EXPECT_FALSE(scenario->description.empty()) << entry.path();
    EXPECT_TRUE(check(scenario->rig())) << entry.path();
  }
  EXPECT_GE(count, 8);
}

TEST_F(ScenarioFile, reads_values_events_and_checks) {
  const auto s = load(R"(format = 1
duration_s = 5
checks = ["settle_s < 6", "permit none within 20 ms of press estop"]
[vehicle]
start_mm = [1, 2, 3]
[vehicle.plant]
mass_kg = 20
[[target]]
name = "dolphin"
[[event]]
at_s = 4
do = "press estop"
[[event]]
at_s = 1
do = "target dolphin"
)");
  ASSERT_TRUE(s) << (s ? "" : s.error().text);
  EXPECT_EQ(s->vehicle.plant.mass_kg, 20);
  ASSERT_EQ(s->events.size(), 2u);
  EXPECT_EQ(s->events[0].action.name, "dolphin");  // in order of time
  EXPECT_EQ(s->checks[1].limit, 20);
}

TEST_F(ScenarioFile, reports_all_that_is_wrong_with_its_line) {
  const auto s = load(R"(duration_s = 5
checks = ["settle_s < soon"]
[vehicle]
start_m = [1, 2, 3]
[[event]]
at_s = 1
do = "press butten"
[[event]]
at_s = 1
do = "target nobody"
[[event]]
at_s = 9
do = "arm"
)");
  ASSERT_FALSE(s);
  const std::string& text = s.error().text;
  for (const char* part : {"toml:2: ", "settle_s < soon", "toml:4: ", "start_m",
                           "toml:7: ", "press butten", "'target nobody'", "'arm' is after the end"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
}

TEST(Scenarios, poses_are_in_the_reference_hand_frame) {
  Scenario s;
  s.vehicle.start_mm = {100, 0, -200};
  s.vehicle.start_turn_deg = {0, 90, 0};  // to the right
  const auto world_from_hand = s.start_pose() * *s.rig().body_from_hand;
  // 100 mm to the right is −y of the world, 200 mm back is −x of it.
  EXPECT_NEAR(world_from_hand.translation.x(), 0.2 - 0.2, 1e-12);
  EXPECT_NEAR(world_from_hand.translation.y(), -0.1, 1e-12);
  const Eigen::Vector3d ahead = world_from_hand.rotation * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(ahead.y(), -1, 1e-12);
  EXPECT_NEAR(ahead.z(), 0, 1e-12);
}

TEST(Scenarios, cameras_can_look_down) {
  Scenario s;
  s.camera.looks = "down";
  const auto ahead = s.world_from_reference().rotation * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(ahead.z(), -1, 1e-12);
  EXPECT_NEAR(s.rig().body_from_hand->rotation.toRotationMatrix().determinant(), 1, 1e-12);
}

}  // namespace
}  // namespace gannet::world
