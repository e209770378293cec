#include "src/world/motors.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <memory>

#include "hal/can/local_bus.hpp"
#include "hal/drive/drive_kinds.hpp"
#include "hal/drive/dronecan_esc_drive.hpp"
#include "src/world/rov_plant.hpp"

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
    auto end = CanEnd::create({"local", bus}, now_);
    ASSERT_TRUE(end) << end.error().text;
    auto motors = Motors::create(std::move(*end), eight_drives(), milliseconds(5), 1);
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

TEST_F(MotorsTest, says_from_when_on_the_drives_were_told_to_stand_still) {
  for (int i = 0; i < 10; ++i) step(0.5, true);
  const TimePoint stop = now_;
  step(0.5, false);
  step(0.5, false);
  ASSERT_EQ(sut_->turns().size(), 3u);
  EXPECT_TRUE(sut_->turns()[0].still);
  EXPECT_FALSE(sut_->turns()[1].still);
  EXPECT_TRUE(sut_->turns()[2].still);
  EXPECT_EQ(sut_->turns()[2].time, stop);  // on the bus; the nodes obey 5 ms later
}

TEST_F(MotorsTest, left_alone_the_drives_stop_by_themselves_and_that_is_told) {
  for (int i = 0; i < 10; ++i) step(0.5, true);
  const TimePoint last = now_;
  for (int i = 0; i < 400; ++i, now_ += milliseconds(5)) sut_->step(now_, plant_);
  EXPECT_EQ(sut_->throttles()[0], 0);
  ASSERT_TRUE(sut_->turns().back().still);
  EXPECT_NEAR(to_seconds(sut_->turns().back().time - last), 0.5, 0.02);  // the nodes' own guard
}

// A bus whose frames have stamps of their own, as SocketCAN's have.
class StampedBus final : public hal::CanBus {
 public:
  int send(std::span<const hal::CanFrame> frames, TimePoint) override {
    return static_cast<int>(frames.size());
  }
  int receive(std::span<hal::ReceivedCanFrame> frames, TimePoint) override {
    const std::size_t count = std::min(frames.size(), waiting.size());
    std::copy_n(waiting.begin(), count, frames.begin());
    waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(count));
    return static_cast<int>(count);
  }
  hal::BusState state() const override { return hal::BusState::kGood; }
  hal::CanCounters counters() const override { return {}; }
  std::vector<hal::ReceivedCanFrame> waiting;
};

TEST(Motors, go_by_the_stamps_of_frames_that_came_between_two_steps) {
  auto owner = std::make_unique<StampedBus>();
  StampedBus& bus = *owner;
  auto end = std::make_unique<CanEnd>(CanEndConfig{}, std::move(owner), switch_link);
  auto sut = Motors::create(std::move(end), eight_drives(), milliseconds(5), 1);
  ASSERT_TRUE(sut);
  auto drive = hal::DroneCanEscDrive::create(eight_drives());
  ASSERT_TRUE(drive);
  std::vector<hal::CanFrame> out(static_cast<std::size_t>((*drive)->max_frames()));
  const std::vector<hal::DriveSetpoint> half(8, hal::DriveSetpoint{0.5});
  const auto say = [&](bool enable, TimePoint time) {
    const int count = (*drive)->send(half, enable, time, out);
    for (int i = 0; i < count; ++i) bus.waiting.push_back({out[static_cast<std::size_t>(i)], time});
  };
  RovPlant plant{RovPlantConfig{}};
  const TimePoint start = time_from_ns(1'000'000'000);
  say(true, start + milliseconds(2));
  say(false, start + milliseconds(7));
  (*sut)->step(start + milliseconds(50), plant);  // a world that was kept from running
  ASSERT_EQ((*sut)->turns().size(), 2u);
  EXPECT_EQ((*sut)->turns()[0].time, start + milliseconds(2));
  EXPECT_EQ((*sut)->turns()[1].time, start + milliseconds(7));
  EXPECT_TRUE((*sut)->turns()[1].still);
}

}  // namespace
}  // namespace gannet::world
