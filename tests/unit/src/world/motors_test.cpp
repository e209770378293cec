#include "src/world/motors.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <memory>

#include "hal/drive/drive_kinds.hpp"
#include "hal/drive/dronecan_esc_drive.hpp"

namespace gannet::world {
namespace {

using std::chrono::milliseconds;

hal::DriveConfig eight_drives() {
  hal::DriveConfig config;
  for (int i = 0; i < 8; ++i) config.motors.push_back({.index = i, .node_id = 20 + i});
  return config;
}

// The daemon's own drive on the other end of the bus, a step of 5 ms as the world makes it.
class MotorsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string bus = "@gannet-motors-test-" + std::to_string(getpid());
    auto motors = Motors::create(bus, eight_drives(), milliseconds(5), 1);
    ASSERT_TRUE(motors) << motors.error().text;
    sut_ = std::move(*motors);
    auto node = hal::LocalBus::connect(bus, now_);
    ASSERT_TRUE(node);
    bus_ = std::move(*node);
    auto drive = hal::DroneCanEscDrive::create(eight_drives());
    ASSERT_TRUE(drive);
    drive_ = std::move(*drive);
    out_.resize(static_cast<std::size_t>(drive_->max_frames()));
  }
  void step(double throttle, bool enable) {
    hal::ReceivedCanFrame in[256];
    const int heard = bus_->receive(in, now_);
    for (int i = 0; i < heard; ++i) drive_->receive(in[i].frame, in[i].time);
    const std::vector<hal::DriveSetpoint> setpoints(8, hal::DriveSetpoint{throttle});
    const int count = drive_->send(setpoints, enable, now_, out_);
    bus_->send(std::span(out_).first(static_cast<std::size_t>(count)), now_);
    sut_->step(now_, plant_);
    plant_.advance(0.005);
    now_ += milliseconds(5);
  }
  TimePoint now_ = time_from_ns(1'000'000'000);
  RovPlant plant_{RovPlantConfig{}};
  std::unique_ptr<Motors> sut_;
  std::unique_ptr<hal::LocalBus> bus_;
  std::unique_ptr<hal::DroneCanEscDrive> drive_;
  std::vector<hal::CanFrame> out_;
};

TEST_F(MotorsTest, commands_arrive_after_the_delay) {
  step(0.5, true);
  EXPECT_EQ(sut_->throttles()[0], 0);
  step(0.5, true);
  EXPECT_NEAR(sut_->throttles()[0], 0.5, 1e-3);
  EXPECT_TRUE(sut_->armed());
  step(0.5, false);
  step(0.5, false);
  EXPECT_EQ(sut_->throttles()[0], 0);
  EXPECT_FALSE(sut_->armed());
}

TEST_F(MotorsTest, the_drive_hears_how_they_turn) {
  for (int i = 0; i < 400; ++i) step(0.5, true);
  EXPECT_TRUE(drive_->health(now_).all_alive);
  EXPECT_NEAR(drive_->feedback()[3].speed_rad_s, steady_speed_rad_s(0.5), 2);
  EXPECT_LT(drive_->feedback()[3].voltage_v, 16);
  EXPECT_NEAR(plant_.thrusters()[3].thrust_n(), 17.9, 0.2);
}

TEST_F(MotorsTest, a_silent_node_is_missed_and_stops_by_itself) {
  for (int i = 0; i < 300; ++i) step(0.5, true);
  sut_->faults(2).silent = true;
  for (int i = 0; i < 120; ++i) step(0.5, true);
  EXPECT_FALSE(drive_->health(now_).all_alive);
  EXPECT_EQ(drive_->health(now_).first_bad, 2);
  EXPECT_EQ(sut_->throttles()[2], 0);
  EXPECT_NEAR(sut_->throttles()[1], 0.5, 1e-3);
}

}  // namespace
}  // namespace gannet::world
