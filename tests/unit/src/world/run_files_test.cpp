#include "src/world/run_files.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace gannet::world {
namespace {

TEST(RunFiles, a_temporary_folder_is_gone_afterwards) {
  std::string folder;
  {
    const auto sut = RunFiles::create("");
    ASSERT_TRUE(sut);
    folder = sut->folder();
    EXPECT_TRUE(std::filesystem::is_directory(folder));
  }
  EXPECT_FALSE(std::filesystem::exists(folder));
}

TEST(RunFiles, a_named_folder_stays) {
  const std::string folder = ::testing::TempDir() + "gannet-run-files-test";
  { ASSERT_TRUE(RunFiles::create(folder)); }
  EXPECT_TRUE(std::filesystem::is_directory(folder));
  std::filesystem::remove_all(folder);
  EXPECT_FALSE(RunFiles::create("/proc/no/such/place"));
}

// What --set would take, the daemon finds beside its config.
TEST(RunFiles, settings_become_a_drop_in) {
  const auto files = RunFiles::create("");
  ASSERT_TRUE(files);
  auto scenario = load_scenario("tests/scenarios/poses_only.toml");
  ASSERT_TRUE(scenario);
  scenario->daemon.settings = {"track.evaluations=777", "realtime.worker_cores=[0, 1]",
                               "frames.directory = kept"};
  ASSERT_TRUE(write_files(*scenario, *files, daemon_config(*scenario, *files, {}, false)));
  ASSERT_TRUE(write_settings(*scenario, *files));
  const auto loaded = config::load_daemon_config({files->config(), {}});
  ASSERT_TRUE(loaded) << loaded.error().text;
  EXPECT_EQ(loaded->config.track.evaluations, 777);
  EXPECT_EQ(loaded->config.realtime.worker_cores, (std::vector<int>{0, 1}));
  EXPECT_TRUE(loaded->config.frames.directory.ends_with("kept"));
  scenario->daemon.settings = {"nothing"};
  EXPECT_FALSE(write_settings(*scenario, *files));
}

// The daemon's own loader takes the config of every kind of scenario.
class DaemonConfigOf : public ::testing::TestWithParam<const char*> {};

TEST_P(DaemonConfigOf, loads_in_the_daemon) {
  const auto files = RunFiles::create("");
  ASSERT_TRUE(files);
  const auto scenario = load_scenario(std::string("tests/scenarios/") + GetParam() + ".toml");
  ASSERT_TRUE(scenario);
  for (const bool stepped : {true, false}) {
    const auto config = daemon_config(*scenario, *files, {}, stepped);
    ASSERT_TRUE(write_files(*scenario, *files, config));
    const auto loaded = config::load_daemon_config({files->config(), {}});
    ASSERT_TRUE(loaded) << loaded.error().text;
    EXPECT_EQ(loaded->config.clock.kind, stepped ? "stepped" : "live");
    EXPECT_EQ(loaded->config.vehicle.kind, scenario->vehicle.kind);
    EXPECT_EQ(loaded->config.drive.motors.size(), scenario->vehicle.kind == "rov" ? 8u : 0u);
    EXPECT_EQ(loaded->config.vehicle.rov.added_mass, config.vehicle.rov.added_mass);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenarios, DaemonConfigOf,
                         ::testing::Values("rov_station_keeping", "poses_only"));

}  // namespace
}  // namespace gannet::world
