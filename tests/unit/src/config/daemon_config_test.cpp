#include "src/config/daemon_config.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>

#include "src/config/printer.hpp"

namespace gannet::config {
namespace {

namespace fs = std::filesystem;

const char* const kRig =
    "[left]\nwidth = 640\nheight = 480\nfx = 640\nfy = 640\ncx = 319.5\ncy = 239.5\n"
    "[right]\nwidth = 640\nheight = 480\nfx = 640\nfy = 640\ncx = 319.5\ncy = 239.5\n"
    "[right_from_left]\nrotation = [1, 0, 0, 0, 1, 0, 0, 0, 1]\ntranslation_m = [-0.12, 0, 0]\n";
const char* const kBody =
    "[body_from_hand]\nrotation = [0, 0, 1, -1, 0, 0, 0, -1, 0]\ntranslation_m = [0.2, 0, 0]\n";

class DaemonConfigTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "gannet_config_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    write("rig.toml", std::string(kRig) + kBody);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }
  Result<LoadedConfig> load(std::vector<std::string> sets = {}) {
    return load_daemon_config(
        {(folder_ / "gannet.toml").string(), std::move(sets), {(folder_ / "boards").string()}});
  }
  // The problems, with the folder's name taken out.
  std::string problems(std::vector<std::string> sets = {}) {
    const auto loaded = load(std::move(sets));
    if (loaded) return "none";
    std::string text = loaded.error().text;
    const std::string prefix = folder_.string() + "/";
    for (std::size_t at; (at = text.find(prefix)) != std::string::npos;)
      text.erase(at, prefix.size());
    return text;
  }

  fs::path folder_;
};

TEST_F(DaemonConfigTest, later_sources_overrule_earlier_ones) {
  write("boards/small.toml",
        "[board]\ncores = 2\n[realtime]\nservo_rate_hz = 50\n"
        "[realtime.capture]\ncore = 1\n[track]\nseed = 2\n");
  write("gannet.toml",
        "rig = \"rig.toml\"\nboard.name = \"small\"\n"
        "[realtime]\nservo_rate_hz = 100\n[track]\nseed = 3\ntilt_deg = 10\n");
  write("gannet.toml.d/20-b.toml", "track.seed = 5\n");
  write("gannet.toml.d/10-a.toml", "track.seed = 4\ntrack.roll_deg = 20\n");
  write("gannet.toml.d/ignored.txt", "nonsense\n");
  const auto sut = load({"track.roll_deg=30", "track.fitness=p001"});
  ASSERT_TRUE(sut) << sut.error().text;
  EXPECT_EQ(sut->config.realtime.capture.core, 1);
  EXPECT_EQ(sut->config.realtime.servo_rate_hz, 100);
  EXPECT_EQ(sut->config.track.seed, 5);
  EXPECT_EQ(sut->config.track.tilt_deg, 10);
  EXPECT_EQ(sut->config.track.roll_deg, 30);
  EXPECT_EQ(sut->config.track.fitness, "p001");
  EXPECT_EQ(sut->config.rig, (folder_ / "rig.toml").string());
  ASSERT_EQ(sut->files.size(), 4u);
  const std::string shown = sut->show();
  for (const std::string& line :
       {"track.seed = 5  # " + folder_.string() + "/gannet.toml.d/20-b.toml:1",
        std::string("track.roll_deg = 30.0  # --set track.roll_deg=30"),
        "realtime.capture.core = 1  # " + folder_.string() + "/boards/small.toml:6",
        std::string("clock.kind = \"live\"  # built-in")}) {
    EXPECT_NE(shown.find(line + "\n"), std::string::npos) << line << "\n" << shown;
  }
}

TEST_F(DaemonConfigTest, all_problems_of_all_sources_are_told_at_once) {
  write("gannet.toml", "rig = \"rig.toml\"\n[track]\nsede = 3\n[safety]\nfull_age_s = 99\n");
  write("gannet.toml.d/a.toml", "[servo]\nlaw = \"pose_regulatio\"\n");
  EXPECT_EQ(problems({"track.seed=x y", "=3", "nonsense", "clock.kind=stoped"}),
            "--set =3: is not of the form room.key=value\n"
            "--set nonsense: is not of the form room.key=value\n"
            "gannet.toml:3: track.sede: unknown key (did you mean seed?)\n"
            "gannet.toml:5: safety.full_age_s: 99 s is outside [0.02, 5]\n"
            "gannet.toml.d/a.toml:2: servo.law: \"pose_regulatio\" is none of pose_regulation, "
            "follow_person "
            "(did you mean pose_regulation?)\n"
            "--set track.seed=x y: track.seed: expects a whole number, found a string\n"
            "--set clock.kind=stoped: clock.kind: \"stoped\" is none of live, stepped "
            "(did you mean stepped?)");
}

TEST_F(DaemonConfigTest, files_that_cannot_be_read_are_told) {
  EXPECT_EQ(problems(), "gannet.toml: cannot be opened: No such file or directory");
  write("gannet.toml", "rig = \"rig.toml\"\nboard.name = \"smal\"\n");
  EXPECT_EQ(problems(), "gannet.toml:2: board.name: there is no board file \"smal\" in boards");
  write("gannet.toml", "rig = \n");
  EXPECT_EQ(problems().substr(0, 14), "gannet.toml:1:");
}

TEST_F(DaemonConfigTest, the_rig_is_loaded_and_its_faults_are_told) {
  write("gannet.toml", "track.seed = 1\n");
  EXPECT_EQ(problems(), "gannet.toml: rig: is not set; it is the path of the cameras' calibration");
  write("gannet.toml", "\nrig = \"other.toml\"\n");
  EXPECT_EQ(problems(),
            "gannet.toml:2: rig: other.toml: cannot be opened: No such file or directory");
  write("other.toml", "[left]\nwidth = 1\n");
  EXPECT_EQ(problems(),
            "gannet.toml:2: rig: other.toml:2: left.width: 1 px is outside [16, 16384]");
  write("other.toml", kRig);
  const auto sut = load();
  ASSERT_TRUE(sut) << sut.error().text;
  EXPECT_NEAR(sut->rig.baseline_m(), 0.12, 1e-12);
}

std::string motors(int count) {
  std::string text;
  for (int i = 0; i < count; ++i)
    text += "[[drive.motor]]\nindex = " + std::to_string(i) +
            "\nnode_id = " + std::to_string(20 + i) + "\n";
  return text;
}

TEST_F(DaemonConfigTest, a_vehicle_needs_a_place_of_the_cameras_and_a_motor_per_thruster) {
  write("gannet.toml", "rig = \"rig.toml\"\n[vehicle]\nkind = \"rov\"\n" + motors(6));
  EXPECT_EQ(problems(), "none");
  EXPECT_EQ(problems({"vehicle.rov.frame=vectored_6dof"}),
            "gannet.toml:4: drive.motor: 6 motors for 8 thrusters; each needs one table "
            "[[drive.motor]], in the order of the thrusters");
  EXPECT_EQ(problems({"vehicle.rov.frame=custom"}),
            "--set vehicle.rov.frame=custom: vehicle.rov.frame: \"custom\" needs a table "
            "[[vehicle.rov.thruster]] for each one");
  write("rig.toml", kRig);
  EXPECT_EQ(problems(),
            "gannet.toml:1: rig: rig.toml has no [body_from_hand], which a vehicle "
            "needs: where the cameras sit on it");
}

// Only DroneCAN has indices, and several motors on a node; only ODrive has no id of ours.
TEST_F(DaemonConfigTest, ids_and_indices_are_judged_by_what_the_motors_speak) {
  std::string six;
  for (const int node : {20, 21, 22, 23, 10, 23})
    six += "[[drive.motor]]\nnode_id = " + std::to_string(node) + "\n";
  write("gannet.toml", "rig = \"rig.toml\"\n[vehicle]\nkind = \"rov\"\n" + six);
  for (const std::string kind : {"cia402", "vesc", "odrive"}) {
    const std::string found = problems({"drive.kind=" + kind});
    EXPECT_EQ(found.find("index"), std::string::npos) << found;
    EXPECT_NE(found.find("drive.motor[5].node_id: 23 is used twice"), std::string::npos) << found;
    EXPECT_EQ(found.find("own_node_id") == std::string::npos, kind == "odrive") << found;
  }
  const std::string found = problems();
  EXPECT_NE(found.find("drive.motor[1].index: 0 is used twice"), std::string::npos) << found;
  EXPECT_EQ(found.find("23 is used twice"), std::string::npos) << found;
}

TEST_F(DaemonConfigTest, escs_that_stop_between_two_commands_are_told) {
  const auto refused = [](const std::vector<std::string>& sets) {
    const auto loaded = load_daemon_config({"docs/examples/rov.toml", sets});
    return loaded ? std::string() : loaded.error().text;
  };
  EXPECT_EQ(refused({"drive.dronecan.esc_timeout_s=0.5"}), "");
  EXPECT_EQ(refused({"drive.command_period_s=0.2"}), "") << "0: not known, and refused at arming";
  const std::string text =
      refused({"drive.dronecan.esc_timeout_s=0.5", "drive.command_period_s=0.2"});
  EXPECT_NE(text.find("drive.dronecan.esc_timeout_s: is shorter than three commands"),
            std::string::npos)
      << text;
}

TEST_F(DaemonConfigTest, groups_that_do_not_fit_each_other_are_told) {
  write("gannet.toml",
        "rig = \"rig.toml\"\n[board]\ncores = 2\n[realtime.servo]\ncore = 2\n"
        "[clock]\nkind = \"stepped\"\n[frames]\nkind = \"directory\"\n"
        "[track]\nz_min_m = 2\n" +
            motors(2) + "[[drive.motor]]\nindex = 0\nnode_id = 10\n");
  EXPECT_EQ(problems(),
            "gannet.toml:5: realtime.servo.core: core 2 does not exist; board.cores is 2\n"
            "gannet.toml:6: clock.step_socket: is needed by clock.kind \"stepped\"\n"
            "gannet.toml:8: frames.directory: is needed by frames.kind \"directory\"\n"
            "gannet.toml:10: track.z_max_m: is not beyond track.z_min_m, 2 m\n"
            "gannet.toml:19: drive.motor[2].index: 0 is used twice\n"
            "gannet.toml:20: drive.motor[2].node_id: is drive.own_node_id, the daemon's own");
}

TEST_F(DaemonConfigTest, a_second_estop_channel_must_move_the_other_way) {
  write("rig.toml", kRig);
  write("gannet.toml", "rig = \"rig.toml\"\n[gpio.estop]\nkind = \"gpiod\"\nline = \"17\"\n");
  EXPECT_EQ(problems({"gpio.estop_second.kind=gpiod", "gpio.estop_second.line=E2"}),
            "--set gpio.estop_second.line=E2: gpio.estop_second.active_low: must differ from "
            "gpio.estop.active_low: one contact opens, the other one closes");
  EXPECT_EQ(problems({"gpio.estop_second.kind=gpiod", "gpio.estop_second.line=E2",
                      "gpio.estop_second.active_low=true"}),
            "none");
  EXPECT_NE(problems({"gpio.estop.kind=none", "gpio.estop_second.kind=gpiod",
                      "gpio.estop_second.active_low=true"})
                .find("needs a first one"),
            std::string::npos);
}

TEST_F(DaemonConfigTest, v4l2_cameras_need_devices_and_a_tolerance_that_fits_the_rate) {
  write("rig.toml", kRig);
  write("gannet.toml",
        "rig = \"rig.toml\"\n[camera]\nkind = \"v4l2_pair\"\n[camera.v4l2_pair]\nleft = \"a\"\n"
        "rate_hz = 20\npair_tolerance_s = 0.025\n");
  EXPECT_EQ(problems(),
            "gannet.toml:4: camera.v4l2_pair.right: is needed by camera.kind \"v4l2_pair\"\n"
            "gannet.toml:7: camera.v4l2_pair.pair_tolerance_s: is not less than half a period, "
            "0.025 s");
  EXPECT_EQ(problems({"camera.kind=v4l2_side_by_side"}),
            "--set camera.kind=v4l2_side_by_side: camera.v4l2_side_by_side.device: is needed by "
            "camera.kind \"v4l2_side_by_side\"");
}

TEST_F(DaemonConfigTest, kinds_that_the_kernel_stamps_need_the_live_clock) {
  write("rig.toml", kRig);
  write("gannet.toml",
        "rig = \"rig.toml\"\n[clock]\nkind = \"stepped\"\nstep_socket = \"step\"\n"
        "[can]\nkind = \"socketcan\"\n[gpio.estop]\nkind = \"gpiod\"\nline = \"ESTOP\"\n");
  EXPECT_EQ(problems(),
            "gannet.toml:6: can.kind: \"socketcan\" needs clock.kind \"live\"\n"
            "gannet.toml:8: gpio.estop.kind: \"gpiod\" needs clock.kind \"live\"");
  EXPECT_NE(problems({"camera.kind=v4l2_side_by_side"})
                .find("camera.kind: \"v4l2_side_by_side\" needs clock.kind \"live\""),
            std::string::npos);
}

TEST(DaemonConfig, the_default_file_loads_back_to_the_built_in_values) {
  const std::string text = print_default();
  const auto tree = parse_toml(text, "default.toml");
  ASSERT_TRUE(tree) << tree.error().text;
  DaemonConfig config;
  Origins origins;
  Problems none;
  config.track.seed = 77;  // is overwritten, so the file really says it
  config::load(*tree, "default.toml", config, origins, none);
  EXPECT_TRUE(none.empty()) << none.error().text;
  EXPECT_EQ(commented_file(config), commented_file(DaemonConfig{}));
  EXPECT_EQ(config.track.seed, 1);
}

TEST(DaemonConfig, every_key_says_what_it_means) {
  const std::string text = config_markdown();
  EXPECT_EQ(text.find("|  |\n"), std::string::npos) << "a key without help";
}

TEST(DaemonConfig, each_board_file_loads) {
  int boards = 0;
  for (const std::string& folder : board_folders()) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      DaemonConfig config;
      Origins origins;
      Problems none;
      const auto tree = read_toml(entry.path().string());
      ASSERT_TRUE(tree) << tree.error().text;
      config::load(*tree, entry.path().string(), config, origins, none);
      EXPECT_TRUE(none.empty()) << none.error().text;
      EXPECT_GE(config.board.cores, 1) << entry.path();
      EXPECT_LT(config.realtime.servo.core, config.board.cores) << entry.path();
      for (const int core : config.realtime.worker_cores) EXPECT_LT(core, config.board.cores);
      ++boards;
    }
  }
  EXPECT_GE(boards, 3);
}

// From the source tree, where `make` runs the tests.
TEST(DaemonConfig, each_example_loads_with_its_rig) {
  if (!fs::exists("docs/examples")) GTEST_SKIP() << "not in the source tree";
  int examples = 0;
  for (const auto& entry : fs::directory_iterator("docs/examples")) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with("rig.toml") || !name.ends_with(".toml")) continue;
    const auto loaded = load_daemon_config({entry.path().string(), {}});
    EXPECT_TRUE(loaded) << loaded.error().text;
    ++examples;
  }
  EXPECT_GE(examples, 2);
}

TEST(DaemonConfig, refuses_an_agv_whose_wheels_take_no_speed_or_turn_too_slowly) {
  if (!fs::exists("docs/examples")) GTEST_SKIP() << "not in the source tree";
  const auto refused = [](const std::string& set, const std::string& why) {
    const auto loaded = load_daemon_config({"docs/examples/agv.toml", {set}});
    ASSERT_FALSE(loaded) << set;
    EXPECT_NE(loaded.error().text.find(why), std::string::npos) << loaded.error().text;
  };
  refused("drive.kind=dronecan_esc", "wheels need a speed");
  refused("drive.kind=vesc", "must be \"speed\"");
  refused("vehicle.agv.gear_ratio=30", "10 rad/s at most");
}

TEST(DaemonConfig, the_arm_example_writes_the_pa10_out) {
  if (!fs::exists("docs/examples")) GTEST_SKIP() << "not in the source tree";
  const auto loaded = load_daemon_config({"docs/examples/arm.toml", {}});
  ASSERT_TRUE(loaded) << loaded.error().text;
  vehicle::ArmConfig built_in, written = loaded->config.vehicle.arm;
  built_in.robot = written.robot;
  built_in.joints = vehicle::pa10_joints();
  for (auto& joint : built_in.joints) joint.gear_ratio = 50;
  EXPECT_EQ(commented_file(written), commented_file(built_in));
  const auto refused = [](const char* set) {
    const auto changed = load_daemon_config({"docs/examples/arm.toml", {set}});
    return changed ? std::string() : changed.error().text;
  };
  EXPECT_NE(refused("drive.cia402.report_position=false").find("must be true for an arm"),
            std::string::npos);
  EXPECT_NE(refused("drive.kind=vesc").find("tells no positions"), std::string::npos);
  EXPECT_NE(refused("vehicle.arm.robot=pa10").find("custom"), std::string::npos);
}

}  // namespace
}  // namespace gannet::config
