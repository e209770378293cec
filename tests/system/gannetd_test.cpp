// The real gannetd as a process of its own, with a replayed pair of pictures and no motors: how it
// starts, answers, stops, and what it says when something is wrong.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/ptrace.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <thread>

#include "hal/camera/image.hpp"
#include "platform/base/random.hpp"
#include "platform/linux/fd.hpp"
#include "src/control/client.hpp"
#include "src/daemon/claimed_interface.hpp"
#include "src/image_file/image_file.hpp"
#include "src/world/daemon_process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace gannet {
namespace {

namespace fs = std::filesystem;
using control::Client;
using control::Json;
using std::chrono::milliseconds;
using std::chrono::seconds;
using world::DaemonProcess;

std::string program() {
  const fs::path test = fs::read_symlink("/proc/self/exe").parent_path();
  return (test / "../../bin/gannetd").lexically_normal();
}

constexpr const char* kRig = R"(
[left]
width = 160
height = 120
fx = 160.0
fy = 160.0
cx = 79.5
cy = 59.5
[right]
width = 160
height = 120
fx = 160.0
fy = 160.0
cx = 79.5
cy = 59.5
[right_from_left]
rotation = [1, 0, 0, 0, 1, 0, 0, 0, 1]
translation_m = [-0.12, 0, 0]
)";

class GannetdTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(program())) GTEST_SKIP() << "no " << program() << ": run make first";
    std::ofstream(folder_ / "rig.toml") << kRig;
    write_pictures();
    write_config("");
  }
  void write_pictures() {
    Random random(3);
    hal::Image left(160, 120, hal::PixelFormat::kRgb24), right = left;
    for (auto& byte : left.bytes()) byte = static_cast<std::uint8_t>(random.below(256));
    constexpr std::size_t kShift = 24 * 3;  // a wall at 0.8 m
    for (int y = 0; y < 120; ++y) {
      for (std::size_t x = 0; x + kShift < 480; ++x)
        right.row(0, y)[x] = left.row(0, y)[x + kShift];
    }
    for (const char* side : {"left", "right"}) {
      fs::create_directories(folder_.path() / "frames" / side);
      const hal::Image& image = side[0] == 'l' ? left : right;
      ASSERT_TRUE(image_file::write_png(folder_ / ("frames/" + std::string(side) + "/1.png"),
                                        image.view()));
    }
  }
  void write_config(const std::string& more) {
    std::ofstream(folder_ / "gannet.toml") << "rig = \"rig.toml\"\n"
                                           << "[control]\nsocket = \"" << folder_ / "control"
                                           << "\"\n[camera]\nkind = \"replay\"\n"
                                           << "replay = { directory = \"frames\", loop = true }\n"
                                           << "[track]\nevaluations = 200\n"
                                           << more;
  }
  DaemonProcess start(std::vector<std::string> more = {}) {
    std::vector<std::string> args = {"-c", folder_ / "gannet.toml"};
    args.insert(args.end(), more.begin(), more.end());
    auto process = DaemonProcess::start(program(), args, folder_ / "log");
    EXPECT_TRUE(process);
    return std::move(*process);
  }
  // One that is expected to end by itself.
  int run_to_end(const std::vector<std::string>& args) {
    auto process = DaemonProcess::start(program(), args, folder_ / "log2");
    EXPECT_TRUE(process);
    for (int i = 0; i < 4000 && process->running(); ++i)
      std::this_thread::sleep_for(milliseconds(5));
    EXPECT_FALSE(process->running());
    return process->exit_code();
  }
  std::string said(const char* log = "log2") {
    std::stringstream text;
    text << std::ifstream(folder_ / log).rdbuf();
    return text.str();
  }
  std::optional<Client> connect() {
    for (int i = 0; i < 2000; ++i) {
      auto client = Client::connect(folder_ / "control");
      if (client) return std::move(*client);
      std::this_thread::sleep_for(milliseconds(5));
    }
    ADD_FAILURE() << "nobody serves: " << said("log");
    return {};
  }
  Json wait_for(Client& client, const std::string& key, const Json& wanted) {
    Json status;
    for (int i = 0; i < 1000; ++i) {
      const auto answer = client.call("status");
      EXPECT_TRUE(answer) << answer.error().text;
      if (!answer) return {};
      status = *answer;
      if (status[key] == wanted) return status;
      std::this_thread::sleep_for(milliseconds(5));
    }
    ADD_FAILURE() << key << " is " << status[key];
    return status;
  }
  test::TemporaryFolder folder_;
};

TEST_F(GannetdTest, starts_into_standby_answers_and_stops_in_order) {
  DaemonProcess daemon = start();
  auto client = connect();
  ASSERT_TRUE(client);
  const Json status = wait_for(*client, "state", "standby");
  EXPECT_EQ(status["permit"], "none");
  EXPECT_EQ(status["vehicle"], "none");
  EXPECT_FALSE(client->call("arm"));
  EXPECT_EQ(client->last_failure()["reason"], "no_vehicle");
  EXPECT_EQ(daemon.stop(seconds(10)), 0);
  EXPECT_FALSE(fs::exists(folder_ / "control"));
  EXPECT_NE(said("log").find("stopping"), std::string::npos);
}

TEST_F(GannetdTest, finds_a_rectangle_and_says_where_it_is) {
  DaemonProcess daemon = start({"--set", "track.z_min_m=0.5", "--set", "track.z_max_m=1.2", "--set",
                                "track.evaluations=2000"});
  auto client = connect();
  ASSERT_TRUE(client);
  ASSERT_TRUE(client->call("target", {{"roi", {60, 40, 40, 40}}}));
  Json estimate;
  for (int i = 0; i < 400; ++i) {
    estimate = (*client->call("status"))["estimate"];
    if (estimate["state"] == "locked") break;
    std::this_thread::sleep_for(milliseconds(20));
  }
  ASSERT_EQ(estimate["state"], "locked") << estimate;
  EXPECT_NEAR(estimate["position_m"][2].get<double>(), 0.8, 0.02);
  EXPECT_EQ(estimate["covariance"].size(), 36u);
  EXPECT_EQ(daemon.stop(seconds(10)), 0);
}

TEST_F(GannetdTest, a_bad_config_ends_with_2_and_every_problem) {
  write_config("[servo]\nposition_gian = 1\n[realtime]\nservo_rate_hz = -3\n");
  EXPECT_EQ(run_to_end({"-c", folder_ / "gannet.toml"}), 2);
  EXPECT_NE(said().find("gannet.toml:"), std::string::npos);
  EXPECT_NE(said().find("position_gain"), std::string::npos) << said();
  EXPECT_NE(said().find("servo_rate_hz"), std::string::npos) << said();
  EXPECT_EQ(run_to_end({"--check", folder_ / "gannet.toml"}), 2);
  EXPECT_EQ(run_to_end({"-c", folder_ / "missing.toml"}), 2);
  EXPECT_EQ(run_to_end({"--no-such-option"}), 2);
}

TEST_F(GannetdTest, check_accepts_a_good_config_and_a_missing_model_is_one_of_it) {
  EXPECT_EQ(run_to_end({"--check", folder_ / "gannet.toml"}), 0) << said();
  EXPECT_EQ(run_to_end({"--check", folder_ / "gannet.toml", "--set", "models=[\"no.gannet\"]"}), 2);
  EXPECT_NE(said().find("no.gannet"), std::string::npos) << said();
}

TEST_F(GannetdTest, check_tells_the_line_of_a_recording_that_is_not_there) {
  std::filesystem::rename(folder_ / "frames", folder_ / "elsewhere");
  EXPECT_EQ(run_to_end({"--check", folder_ / "gannet.toml"}), 2);
  EXPECT_NE(said().find("gannet.toml:6: camera.replay.directory: "), std::string::npos) << said();
}

TEST_F(GannetdTest, a_device_that_is_missing_ends_with_3_and_its_name) {
  EXPECT_EQ(run_to_end({"-c", folder_ / "gannet.toml", "--set", "camera.kind=simulated", "--set",
                        "camera.simulated.name=gannet-nobody", "--set",
                        "camera.simulated.connect_timeout_s=0.05"}),
            3);
  EXPECT_NE(said().find("camera"), std::string::npos) << said();
  EXPECT_NE(said().find("gannet-nobody"), std::string::npos) << said();
}

TEST_F(GannetdTest, pictures_that_do_not_fit_the_rig_are_refused) {
  std::string rig = kRig;
  for (std::size_t at = 0; (at = rig.find("width = 160", at)) != std::string::npos;) {
    rig.replace(at, 11, "width = 320");
  }
  std::ofstream(folder_ / "rig.toml") << rig;
  EXPECT_EQ(run_to_end({"-c", folder_ / "gannet.toml"}), 3);
  EXPECT_NE(said().find("160 × 120"), std::string::npos) << said();
}

TEST_F(GannetdTest, a_second_daemon_is_refused_and_the_first_one_goes_on) {
  DaemonProcess first = start();
  auto client = connect();
  ASSERT_TRUE(client);
  EXPECT_EQ(run_to_end({"-c", folder_ / "gannet.toml"}), 3);
  EXPECT_NE(said().find("already served"), std::string::npos) << said();
  EXPECT_TRUE(client->call("status"));
  EXPECT_EQ(first.stop(seconds(10)), 0);
}

TEST_F(GannetdTest, a_second_daemon_with_a_socket_of_its_own_is_refused_the_same_bus) {
  std::ofstream(folder_ / "rig.toml", std::ios::app)
      << "[body_from_hand]\nrotation = [0, 0, 1, -1, 0, 0, 0, -1, 0]\n"
      << "translation_m = [0.2, 0, 0]\n";
  std::string motors;
  for (int i = 0; i < 6; ++i) {
    motors += "[[drive.motor]]\nindex = " + std::to_string(i) +
              "\nnode_id = " + std::to_string(20 + i) + "\n";
  }
  const std::string interface = "t" + std::to_string(getpid());
  write_config(
      "[vehicle]\nkind = \"rov\"\nrov.frame = \"vectored\"\n[can]\nkind = \"socketcan\"\n" +
      ("interface = \"" + interface + "\"\n") + motors);
  const auto first = daemon::claim_interface(interface);
  ASSERT_TRUE(first) << first.error().text;
  EXPECT_EQ(run_to_end({"-c", folder_ / "gannet.toml"}), 3);
  EXPECT_NE(said().find("another gannetd commands " + interface), std::string::npos) << said();
}

TEST_F(GannetdTest, one_that_was_killed_leaves_nothing_that_hinders_the_next) {
  {
    DaemonProcess killed = start();
    ASSERT_TRUE(connect());
    kill(killed.pid(), SIGKILL);
    killed.stop(seconds(5));
  }
  ASSERT_TRUE(fs::exists(folder_ / "control"));
  DaemonProcess next = start();
  auto client = connect();
  ASSERT_TRUE(client);
  EXPECT_EQ(wait_for(*client, "state", "standby")["permit"], "none");
  EXPECT_EQ(next.stop(seconds(10)), 0);
}

TEST_F(GannetdTest, junk_on_the_socket_is_counted_and_harms_nobody) {
  DaemonProcess daemon = start();
  auto client = connect();
  ASSERT_TRUE(client);
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    auto junk = linux_os::UnixSocket::connect(folder_ / "control", linux_os::SocketKind::kStream);
    ASSERT_TRUE(junk);
    std::string bytes(static_cast<std::size_t>(1 + random.below(3000)), ' ');
    for (char& c : bytes) c = static_cast<char>(random.below(256));
    bytes += '\n';
    junk->send(std::as_bytes(std::span(bytes)));
  }
  for (int i = 0; i < 200; ++i) {
    const auto status = client->call("status");
    ASSERT_TRUE(status) << status.error().text;
    if ((*status)["control"]["junk"].get<int>() >= 50) break;
    std::this_thread::sleep_for(milliseconds(5));
  }
  EXPECT_GE((*client->call("status"))["control"]["junk"].get<int>(), 50);
  EXPECT_EQ(daemon.stop(seconds(10)), 0);
}

TEST_F(GannetdTest, ends_of_interrupts_and_events_are_told) {
  DaemonProcess daemon = start();
  auto client = connect();
  ASSERT_TRUE(client);
  wait_for(*client, "state", "standby");
  const auto events = client->call("events");
  ASSERT_TRUE(events);
  bool started = false;
  for (const Json& event : (*events)["events"]) started |= event["name"] == "started";
  EXPECT_TRUE(started);
  kill(daemon.pid(), SIGINT);
  for (int i = 0; i < 2000 && daemon.running(); ++i) std::this_thread::sleep_for(milliseconds(5));
  EXPECT_FALSE(daemon.running());
  EXPECT_EQ(daemon.exit_code(), 0);
}

// Plays the service manager: gannetd is started under it and writes to its socket.
class ServiceManagerTest : public GannetdTest {
 protected:
  static constexpr int kLimitMs = 600;

  void SetUp() override {
    GannetdTest::SetUp();
    if (IsSkipped()) return;
    const std::string path = folder_ / "notify";
    sockaddr_un address = {};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    ASSERT_EQ(bind(socket_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    setenv("NOTIFY_SOCKET", path.c_str(), 1);
    setenv("WATCHDOG_USEC", std::to_string(kLimitMs * 1000).c_str(), 1);
  }
  void TearDown() override {
    unsetenv("NOTIFY_SOCKET");
    unsetenv("WATCHDOG_USEC");
  }
  // The next message; "" when none comes within the patience.
  std::string next(milliseconds patience = seconds(10)) {
    const timeval limit = {patience.count() / 1000, patience.count() % 1000 * 1000};
    setsockopt(socket_.get(), SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    char text[64];
    const ssize_t n = recv(socket_.get(), text, sizeof text, 0);
    return std::string(text, n > 0 ? static_cast<std::size_t>(n) : 0);
  }
  const linux_os::Fd socket_{socket(AF_UNIX, SOCK_DGRAM, 0)};
};

TEST_F(ServiceManagerTest, is_told_and_fed) {
  DaemonProcess daemon = start();
  EXPECT_EQ(next(), "READY=1");
  EXPECT_EQ(next(), "WATCHDOG=1");
  EXPECT_EQ(next(), "WATCHDOG=1");
  EXPECT_EQ(daemon.stop(seconds(10)), 0);
  std::string last = next();
  while (last == "WATCHDOG=1") last = next();
  EXPECT_EQ(last, "STOPPING=1");
}

// One thread of another process, held still as a debugger does it.
class HeldThread {
 public:
  explicit HeldThread(pid_t thread) : thread_(thread) {
    held_ = ptrace(PTRACE_SEIZE, thread, nullptr, nullptr) == 0 &&
            ptrace(PTRACE_INTERRUPT, thread, nullptr, nullptr) == 0 &&
            waitpid(thread, nullptr, __WALL) == thread;
  }
  ~HeldThread() {
    if (held_) ptrace(PTRACE_DETACH, thread_, nullptr, nullptr);
  }
  HeldThread(const HeldThread&) = delete;
  HeldThread& operator=(const HeldThread&) = delete;
  bool held() const { return held_; }

 private:
  const pid_t thread_;
  bool held_ = false;
};

pid_t thread_named(pid_t process, const std::string& name) {
  for (const auto& task : fs::directory_iterator("/proc/" + std::to_string(process) + "/task")) {
    std::string comm;
    std::getline(std::ifstream(task.path() / "comm"), comm);
    if (comm == name) return std::stoi(task.path().filename());
  }
  return -1;
}

TEST_F(ServiceManagerTest, hears_nothing_while_one_loop_hangs) {
  DaemonProcess daemon = start();
  EXPECT_EQ(next(), "READY=1");
  EXPECT_EQ(next(), "WATCHDOG=1");
  for (const char* loop : {"capture", "vision", "servo"}) {
    {
      const HeldThread hung(thread_named(daemon.pid(), std::string("gannet-") + loop));
      if (!hung.held()) GTEST_SKIP() << "no right to hold threads of a child (ptrace)";
      // What the loop did before it hung may still be told, once.
      std::this_thread::sleep_for(milliseconds(kLimitMs / 2));
      while (!next(milliseconds(1)).empty()) {
      }
      EXPECT_EQ(next(milliseconds(2 * kLimitMs)), "") << loop;
    }
    EXPECT_EQ(next(), "WATCHDOG=1") << loop << " goes on again";
    EXPECT_NE(said("log").find(std::string("stand still: ") + loop), std::string::npos)
        << said("log");
  }
  EXPECT_EQ(daemon.stop(seconds(10)), 0);
}

TEST_F(GannetdTest, what_it_records_can_be_replayed) {
  DaemonProcess daemon = start(
      {"--set", "frames.kind=directory", "--set", "frames.directory=" + (folder_ / "record")});
  auto client = connect();
  ASSERT_TRUE(client);
  wait_for(*client, "state", "standby");
  for (int i = 0; i < 400; ++i) {
    if (fs::exists(folder_ / "record/right")) {
      const auto files = fs::directory_iterator(folder_ / "record/right");
      if (std::distance(begin(files), end(files)) >= 3) break;
    }
    std::this_thread::sleep_for(milliseconds(10));
  }
  EXPECT_EQ(daemon.stop(seconds(10)), 0);
  DaemonProcess replay = start({"--set", "camera.replay.directory=" + (folder_ / "record")});
  auto again = connect();
  ASSERT_TRUE(again);
  EXPECT_EQ(wait_for(*again, "state", "standby")["camera"], "replay");
  EXPECT_EQ(replay.stop(seconds(10)), 0) << said("log");
}

}  // namespace
}  // namespace gannet
