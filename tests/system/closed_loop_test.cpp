// The shipped scenarios with the real gannetd as a process of its own, in stepped time, so that
// verdicts do not hang on the machine's load. Small images and few evaluations keep each short;
// gannet-world runs the same files at full size.
#include <gtest/gtest.h>

#include <filesystem>

#include "src/world/assets.hpp"
#include "src/world/run_record.hpp"
#include "src/world/scenario.hpp"
#include "src/world/simulation.hpp"

namespace gannet::world {
namespace {

// build/<profile>/tests/system/run → build/<profile>/bin/gannetd
std::string gannetd() {
  const auto test = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  return (test / "../../bin/gannetd").lexically_normal();
}

Scenario small(const std::string& name) {
  auto scenario = load_scenario("tests/scenarios/" + name + ".toml");
  EXPECT_TRUE(scenario) << (scenario ? "" : scenario.error().text);
  if (!scenario) return {};
  scenario->camera.width = 320;
  scenario->camera.height = 240;
  scenario->camera.focal_px = 320;
  scenario->camera.fps = 20;
  for (const char* setting :
       {"track.evaluations=4000", "track.evaluations_tracking=300", "track.model_points=300"})
    scenario->daemon.settings.emplace_back(setting);
  return *scenario;
}

SimulationOptions options() {
  SimulationOptions options;
  options.gannetd = gannetd();
  options.assets = assets_folder();
  return options;
}

Result<RunResult> run(const Scenario& scenario, const SimulationOptions& how) {
  auto simulation = Simulation::create(scenario, how);
  if (!simulation) return simulation.error();
  return (*simulation)->run([](const TraceRow&) {});
}

// Stepped runs use one thread, and a sanitizer slows them tenfold: then one with all parts must do.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSlow = true;
#else
constexpr bool kSlow = false;
#endif

void expect_all_passed(const std::string& name) {
  if (kSlow && name != "rov_estop") GTEST_SKIP() << "slow under a sanitizer";
  const auto result = run(small(name), options());
  ASSERT_TRUE(result) << result.error().text;
  EXPECT_TRUE(result->passed()) << result_table(*result);
}

TEST(ClosedLoop, comes_to_a_still_target) { expect_all_passed("rov_still"); }
TEST(ClosedLoop, obeys_the_estop) { expect_all_passed("rov_estop"); }
TEST(ClosedLoop, loses_and_finds_its_target) { expect_all_passed("rov_lost_and_found"); }
TEST(ClosedLoop, stops_when_a_drive_is_silent) { expect_all_passed("rov_drive_silent"); }
TEST(ClosedLoop, servoes_by_vescs_and_stops_when_one_is_silent) { expect_all_passed("rov_vesc"); }
TEST(ClosedLoop, servoes_by_odrives_and_resets_a_fault) { expect_all_passed("rov_odrive"); }
TEST(ClosedLoop, servoes_by_cia402_drives_and_stops_at_a_fault) { expect_all_passed("rov_cia402"); }
TEST(ClosedLoop, holds_while_the_cameras_are_blind) { expect_all_passed("rov_camera_blind"); }

TEST(ClosedLoop, follows_a_person_while_the_light_goes) { expect_all_passed("agv_follow"); }
TEST(ClosedLoop, stands_while_a_person_comes_nearer) { expect_all_passed("agv_nearer"); }

TEST(ClosedLoop, holds_against_a_current) { expect_all_passed("rov_current"); }
TEST(ClosedLoop, goes_where_a_hand_steers_and_comes_back) { expect_all_passed("rov_manual"); }
TEST(ClosedLoop, follows_with_frames_missing) { expect_all_passed("rov_dropped_frames"); }
TEST(ClosedLoop, follows_the_papers_path) { expect_all_passed("rov_station_keeping"); }
TEST(ClosedLoop, follows_it_through_flat_ports) { expect_all_passed("rov_port"); }
TEST(ClosedLoop, visits_targets_in_turn_and_gives_one_up) { expect_all_passed("rov_mission"); }

TEST(ClosedLoop, holds_on_frozen_and_backward_frames) { expect_all_passed("rov_camera_faults"); }
TEST(ClosedLoop, stops_when_the_bus_is_off_or_down) { expect_all_passed("rov_bus_faults"); }
TEST(ClosedLoop, endures_a_late_drive_and_stops_for_a_broken_one) {
  expect_all_passed("rov_drive_faults");
}

TEST(ClosedLoop, gives_poses_without_a_vehicle) { expect_all_passed("poses_only"); }

TEST(ClosedLoop, repeats_bit_for_bit) {
  if (kSlow) GTEST_SKIP() << "slow under a sanitizer";
  Scenario scenario = small("rov_still");
  scenario.duration_s = 2;
  const auto a = run(scenario, options());
  const auto b = run(scenario, options());
  scenario.seed = 2;
  const auto other = run(scenario, options());
  ASSERT_TRUE(a && b && other);
  const std::string text = trace_csv(a->trace);
  EXPECT_EQ(text, trace_csv(b->trace));
  EXPECT_NE(text, trace_csv(other->trace));
}

// A check that cannot hold must fail: nothing else shows that the others can.
TEST(ClosedLoop, a_run_can_fail) {
  Scenario scenario = small("rov_still");
  scenario.duration_s = 1;
  scenario.checks = {*parse_check("rms_mm < 1"), *parse_check("throttle = 0")};
  const auto result = run(scenario, options());
  ASSERT_TRUE(result) << result.error().text;
  EXPECT_FALSE(result->verdicts[0].passed);
  EXPECT_FALSE(result->verdicts[1].passed);
  EXPECT_FALSE(result->passed());
}

TEST(ClosedLoop, a_daemon_that_ends_is_noticed) {
  SimulationOptions how = options();
  how.gannetd = "/bin/false";
  const auto result = run(small("rov_still"), how);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().text.find("ended with exit code 1"), std::string::npos);
}

TEST(ClosedLoop, a_daemon_refuses_a_wrong_setting_of_the_scenario) {
  Scenario scenario = small("rov_still");
  scenario.daemon.settings.push_back("track.evaluatons=4000");
  const auto result = run(scenario, options());
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().text.find("ended with exit code 2"), std::string::npos);
}

}  // namespace
}  // namespace gannet::world
