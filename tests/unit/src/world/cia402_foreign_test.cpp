// Against python-canopen, where it is installed: it leads our simulated drive, and plays a drive
// for our drive group.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <thread>

#include "hal/can/local_bus.hpp"
#include "hal/drive/cia402_drive.hpp"
#include "hal/drive/cia402_objects.hpp"
#include "src/world/cia402_node.hpp"
#include "tests/support/temporary_folder.hpp"

namespace gannet::world {
namespace {

using std::chrono::milliseconds;

constexpr int kNode = 21;

bool has_canopen() { return std::system("python3 -c 'import can, canopen' 2>/dev/null") == 0; }

TimePoint clock_now() {
  return TimePoint(
      std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch()));
}

class Cia402Foreign : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_canopen()) GTEST_SKIP() << "python-canopen is not installed";
    std::ofstream(folder_ / "drive.eds") << hal::cia402::eds_text();
    hub_ = std::move(hal::LocalCanHub::listen(folder_ / "can")).value();
  }
  void TearDown() override {
    if (peer_ > 0) {
      kill(peer_, SIGTERM);
      waitpid(peer_, nullptr, 0);
    }
  }
  void start(const char* role) {
    const std::string bus = folder_ / "can", eds = folder_ / "drive.eds";
    peer_ = fork();
    if (peer_ != 0) return;
    execlp("python3", "python3", "tests/support/cia402_peer.py", role, bus.c_str(), eds.c_str(),
           nullptr);
    _exit(127);
  }
  // Steps each few milliseconds until it is so; false: not within this time.
  bool until(Duration limit, const std::function<bool()>& step) {
    const TimePoint end = clock_now() + limit;
    while (clock_now() < end) {
      if (step()) return true;
      std::this_thread::sleep_for(milliseconds(4));
    }
    return false;
  }
  std::span<const hal::ReceivedCanFrame> heard() {
    const int n = hub_->receive(frames_, clock_now());
    return std::span(frames_).first(static_cast<std::size_t>(n));
  }

  test::TemporaryFolder folder_;
  std::unique_ptr<hal::LocalCanHub> hub_;
  std::array<hal::ReceivedCanFrame, 64> frames_;
  pid_t peer_ = -1;
};

TEST_F(Cia402Foreign, LeadsOurDriveThroughItsStates) {
  Cia402Node node(kNode);
  node.power_on(clock_now());
  start("master");
  int status = -1;
  const bool ended = until(std::chrono::seconds(15), [&] {
    const TimePoint now = clock_now();
    for (const auto& received : heard()) node.hear(received.frame, now);
    node.measure(node.demand(), 0, 24000);
    node.step(now);
    const auto said = node.take_said();
    hub_->send(said, now);
    return waitpid(peer_, &status, WNOHANG) == peer_;
  });
  ASSERT_TRUE(ended);
  peer_ = -1;
  EXPECT_EQ(status, 0);
}

TEST_F(Cia402Foreign, IsSetUpAndCommandedByOurDriveGroup) {
  hal::DriveConfig config;
  config.motors.push_back({.node_id = kNode, .full_speed_rad_s = 104.71975511965978});
  auto drive = std::move(hal::Cia402Drive::create(config)).value();
  start("slave");
  hal::DriveSetpoint setpoint = {0.5};
  bool enable = false;
  const auto cycle = [&] {
    const TimePoint now = clock_now();
    for (const auto& received : heard()) drive->receive(received.frame, now);
    hal::CanFrame out[8];
    const int n = drive->send({&setpoint, 1}, enable, now, out);
    hub_->send(std::span(out).first(static_cast<std::size_t>(n)), now);
  };
  const auto ready = [&] {
    cycle();
    return drive->health(clock_now()).all_ready;
  };
  ASSERT_TRUE(until(std::chrono::seconds(15), ready));
  EXPECT_TRUE(drive->health(clock_now()).guards_itself);
  enable = true;
  EXPECT_TRUE(until(std::chrono::seconds(3), [&] {
    cycle();
    return std::abs(drive->feedback()[0].speed_rad_s - 52.36) < 0.01;
  }));
  EXPECT_EQ(drive->feedback()[0].state, hal::DriveState::kEnabled);
  EXPECT_NEAR(drive->feedback()[0].current_a, 2.5, 1e-9);  // 250 per mille of 10 A
  enable = false;
  EXPECT_TRUE(until(std::chrono::seconds(3), [&] {
    cycle();
    return drive->feedback()[0].state == hal::DriveState::kDisabled;
  }));
  EXPECT_EQ(drive->malformed(), 0u);
}

}  // namespace
}  // namespace gannet::world
