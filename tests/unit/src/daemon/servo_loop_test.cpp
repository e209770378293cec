#include "src/daemon/servo_loop.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "src/daemon/reports.hpp"
#include "src/telemetry/event_codes.hpp"
#include "tests/support/daemon_fakes.hpp"

namespace gannet::daemon {
namespace {

using safety::Cause;
using safety::Request;
using safety::State;
using std::chrono::milliseconds;

constexpr Duration kPeriod = milliseconds(5);

StereoRig rig() {
  StereoRig rig;
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  rig.body_from_hand = Transform<Body, Hand>{Eigen::Quaterniond(axes), {0.2, 0, 0}};
  return rig;
}

class BrokenVehicle final : public vehicle::Vehicle {
 public:
  int motors() const override { return 1; }
  vehicle::Reach update(const MotionWish&, Permit, Duration,
                        std::span<hal::DriveSetpoint> setpoints) override {
    setpoints[0].value = std::numeric_limits<double>::quiet_NaN();
    return {};
  }
  Twist<Body> own_velocity() const override { return {}; }
  void reset() override {}
};

class ServoLoopTest : public testing::Test {
 protected:
  ServoLoopTest() {
    facts_.capture_cycles = 1;
    facts_.vision_cycles = 1;
    vehicle::VehicleConfig config;
    config.kind = "rov";
    vehicle_ = std::move(*vehicle::create_vehicle(config));
    law_ = std::move(*servo::create_servo_law({}, rig()));
    make(vehicle_.get());
  }
  void make(vehicle::Vehicle* vehicle, hal::DigitalInput* estop_second = nullptr) {
    const bool has_motors = vehicle->motors() > 0;
    sut_ = std::make_unique<ServoLoop>(
        ServoLoop::Links{vehicle, law_.get(), has_motors ? &bus_ : nullptr,
                         has_motors ? &drives_ : nullptr, has_estop_ ? &estop_ : nullptr, &light_,
                         &targets_, &commands_, &params_, &report_, &events_, &facts_,
                         estop_second},
        rig(), safety_, track::FilterConfig{}, servo::ServoParams{}, kPeriod);
  }
  const ServoReport& step(int cycles = 1) {
    for (int i = 0; i < cycles; ++i) {
      now_ += kPeriod;
      facts_.last_frame_ns = to_ns(now_);
      sut_->step(now_);
    }
    return report_.read();
  }
  void see(double x_m, TrackState state = TrackState::kLocked) {
    SeenTarget seen;
    seen.estimate.capture_time = now_ - milliseconds(30);
    seen.estimate.target_id = 1;
    seen.estimate.found = true;
    seen.estimate.state = state;
    seen.estimate.reason = TrackReason::kNone;
    seen.estimate.left_from_target.translation = {x_m, 0, 0.6};
    seen.estimate.covariance = Matrix6d::Identity() * 1e-6;
    targets_.push(seen);
  }
  State state() { return report_.read().supervisor.state; }
  void ask(Request request) {
    ServoCommand command;
    command.request = request;
    command.number = ++asked_;
    commands_.push(command);
    step();
    EXPECT_EQ(report_.read().served, asked_);
  }
  void push_hand(double forward_m_s, Duration after = {}) {
    ServoCommand command;
    command.by_hand = true;
    command.velocity.linear.x() = forward_m_s;
    command.time = now_ + after;
    command.number = ++asked_;
    commands_.push(command);
  }
  void start_servoing() {
    step(2);
    ask(Request::kArm);
    for (int i = 0; i < 4; ++i) {
      see(0.1);
      step(2);
    }
    ASSERT_EQ(state(), State::kServoing);
  }

  TimePoint now_ = time_from_ns(10'000'000'000);
  test::FakeBus bus_;
  test::FakeDrives drives_{6};
  test::FakeInput estop_;
  bool has_estop_ = true;
  safety::SafetyConfig safety_;
  test::FakeOutput light_;
  std::unique_ptr<vehicle::Vehicle> vehicle_;
  std::unique_ptr<servo::ServoLaw> law_;
  SpscRing<SeenTarget> targets_{8};
  SpscRing<ServoCommand> commands_{8};
  LatestValue<servo::ServoParams> params_;
  LatestValue<ServoReport> report_;
  EventPort events_;
  SharedFacts facts_;
  std::unique_ptr<ServoLoop> sut_;
  std::uint64_t asked_ = 0;
};

TEST_F(ServoLoopTest, waits_in_standby_with_motors_stopped_whatever_is_seen) {
  step(2);
  for (int i = 0; i < 20; ++i) {
    see(0.2);
    step(2);
  }
  EXPECT_EQ(state(), State::kStandby);
  EXPECT_FALSE(drives_.enabled);
  EXPECT_EQ(drives_.largest(), 0);
}

TEST_F(ServoLoopTest, armed_with_a_locked_target_it_moves) {
  start_servoing();
  EXPECT_TRUE(drives_.enabled);
  EXPECT_GT(drives_.largest(), 0.05);
  EXPECT_GT(report_.read().error.position_m.x(), 0.05);
}

TEST_F(ServoLoopTest, the_emergency_stop_stops_the_motors_in_the_same_cycle) {
  start_servoing();
  estop_.says = {.level = hal::Level::kHigh};
  step();
  EXPECT_EQ(state(), State::kStopped);
  EXPECT_FALSE(drives_.enabled);
  EXPECT_EQ(drives_.largest(), 0);
}

TEST_F(ServoLoopTest, a_press_shorter_than_a_cycle_stops_too_and_release_does_not_start) {
  start_servoing();
  estop_.says = {.level = hal::Level::kLow, .rose = true, .fell = true};
  step();
  estop_.says = {.level = hal::Level::kLow};
  see(0.1);
  step(10);
  EXPECT_EQ(state(), State::kStopped);
  EXPECT_FALSE(drives_.enabled);
}

TEST_F(ServoLoopTest, a_line_that_cannot_be_read_is_a_stop) {
  start_servoing();
  estop_.says = {.level = hal::Level::kUnknown};
  step();
  EXPECT_EQ(report_.read().supervisor.cause, Cause::kEstopUnknown);
  EXPECT_FALSE(drives_.enabled);
}

TEST_F(ServoLoopTest, drives_that_are_not_set_up_or_would_run_on_bar_arming) {
  step(2);
  drives_.says.all_ready = false;
  ask(Request::kArm);
  EXPECT_EQ(report_.read().refused, Cause::kDrivesNotReady);
  drives_.says.all_ready = true;
  drives_.says.guards_itself = false;
  ask(Request::kArm);
  EXPECT_EQ(report_.read().refused, Cause::kDrivesUnguarded);
  EXPECT_EQ(state(), State::kStandby);
  drives_.says.guards_itself = true;
  ask(Request::kArm);
  EXPECT_EQ(state(), State::kArmed);
}

TEST_F(ServoLoopTest, a_persons_reset_reaches_the_drives_unless_it_is_refused) {
  start_servoing();
  EXPECT_EQ(drives_.resets, 0);
  estop_.says = {.level = hal::Level::kHigh};
  step();
  ask(Request::kReset);
  EXPECT_EQ(drives_.resets, 0);
  estop_.says = {.level = hal::Level::kLow};
  step(20);
  ask(Request::kReset);
  EXPECT_EQ(state(), State::kStandby);
  EXPECT_EQ(drives_.resets, 1);
  step(5);
  EXPECT_EQ(drives_.resets, 1);
}

TEST_F(ServoLoopTest, a_release_that_bounces_is_not_yet_one) {
  step(2);
  estop_.says = {.level = hal::Level::kHigh};
  step();
  estop_.says = {.level = hal::Level::kLow};
  step(5);  // 25 of 50 ms
  ask(Request::kReset);
  EXPECT_EQ(state(), State::kStopped);
  EXPECT_EQ(report_.read().refused, Cause::kEstop);
  step(10);
  ask(Request::kReset);
  EXPECT_EQ(state(), State::kStandby);
  EXPECT_EQ(report_.read().estop_presses, 1u);
  EXPECT_TRUE(report_.read().has_estop);
}

TEST_F(ServoLoopTest, the_second_contact_stops_too_and_a_broken_one_is_told) {
  test::FakeInput second;
  make(vehicle_.get(), &second);
  start_servoing();
  second.says = {.level = hal::Level::kHigh};
  step();
  EXPECT_EQ(state(), State::kStopped);
  EXPECT_FALSE(drives_.enabled);
  step(30);
  EXPECT_EQ(report_.read().estop_discrepancies, 1u);
  bool is_told = false;
  for (Event event; events_.take(event);) is_told |= event.code == telemetry::kEstopDiscrepancy;
  EXPECT_TRUE(is_told);
  second.says = {.level = hal::Level::kLow};
  step(30);
  ask(Request::kReset);
  EXPECT_EQ(report_.read().refused, Cause::kEstopUnknown);
  EXPECT_EQ(state(), State::kStopped);
}

TEST_F(ServoLoopTest, nothing_moves_on_a_bus_that_is_off) {
  start_servoing();
  bus_.says = hal::BusState::kPassive;
  step(5);
  EXPECT_TRUE(drives_.enabled) << "a passive controller still sends";
  bus_.says = hal::BusState::kOff;
  step();
  EXPECT_EQ(report_.read().supervisor.cause, Cause::kBusDown);
  EXPECT_FALSE(drives_.enabled);
}

TEST_F(ServoLoopTest, holds_when_the_estimate_is_too_old) {
  start_servoing();
  step(70);  // 350 ms without an image
  EXPECT_EQ(state(), State::kHolding);
  EXPECT_EQ(report_.read().outputs.permit, Permit::kHoldOnly);
}

TEST_F(ServoLoopTest, faults_when_a_drive_is_silent_or_the_bus_is_down) {
  start_servoing();
  for (Event event; events_.take(event);) continue;
  drives_.says = {.all_alive = false, .first_bad = 2};
  step();
  EXPECT_EQ(report_.read().supervisor.cause, Cause::kDrivesSilent);
  EXPECT_FALSE(drives_.enabled);
  std::string told;
  for (Event event; events_.take(event);) told += telemetry::text_of(event, word_of) + "; ";
  EXPECT_NE(told.find("motor 3 is not heard"), std::string::npos) << told;
  drives_.says = {.all_alive = true};
  ask(Request::kReset);
  EXPECT_EQ(state(), State::kStandby);
  bus_.says = hal::BusState::kDown;
  step();
  EXPECT_EQ(report_.read().outputs.obstacle, Cause::kBusDown);
}

TEST_F(ServoLoopTest, a_motor_that_is_too_hot_or_draws_too_much_for_long_is_a_fault) {
  safety_.motor_temperature_c = 80;
  safety_.motor_current_a = 20;
  hal::DriveFeedback hot, drawing;
  hot.temperature_k = 273.15 + 81;
  drawing.current_a = -21;
  for (const hal::DriveFeedback& bad : {hot, drawing}) {
    make(vehicle_.get());
    drives_.felt.assign(6, {});
    start_servoing();
    drives_.felt[2] = bad;
    step(198);  // 990 ms
    EXPECT_NE(state(), State::kFaulted);
    step(6);
    EXPECT_EQ(state(), State::kFaulted);
    EXPECT_EQ(report_.read().supervisor.cause, Cause::kLimits);
    EXPECT_FALSE(drives_.enabled);
  }
}

TEST_F(ServoLoopTest, motors_without_limits_in_the_config_are_not_watched) {
  start_servoing();
  drives_.felt.assign(6, {});
  drives_.felt[2].temperature_k = 500;
  drives_.felt[2].current_a = 500;
  step(300);
  EXPECT_NE(state(), State::kFaulted);
}

TEST_F(ServoLoopTest, without_an_estop_it_arms_only_where_the_config_accepts_that) {
  has_estop_ = false;
  make(vehicle_.get());
  step(2);
  ask(Request::kArm);
  EXPECT_EQ(state(), State::kStandby);
  EXPECT_EQ(report_.read().refused, Cause::kNoEstop);
  EXPECT_FALSE(report_.read().has_estop);
  safety_.accept_no_estop = true;
  make(vehicle_.get());
  step(2);
  ask(Request::kArm);
  EXPECT_EQ(state(), State::kArmed);
}

TEST_F(ServoLoopTest, a_person_steers_by_hand_until_the_time_out) {
  step(2);
  ask(Request::kArm);
  for (int i = 0; i < 20; ++i) {
    push_hand(0.3);
    step(2);
  }
  EXPECT_TRUE(report_.read().outputs.by_hand);
  EXPECT_GT(drives_.largest(), 0.05);
  step(62);  // 310 ms of silence
  EXPECT_FALSE(report_.read().outputs.by_hand);
  EXPECT_NE(state(), State::kServoing);
}

TEST_F(ServoLoopTest, a_hand_command_is_as_old_as_its_arrival_not_as_its_reading) {
  start_servoing();
  push_hand(0.3);
  now_ += milliseconds(280);  // it waited: a loop that hung
  step();
  EXPECT_TRUE(report_.read().outputs.by_hand);
  step(4);  // 305 ms after its arrival
  EXPECT_FALSE(report_.read().outputs.by_hand);
  push_hand(0.3);
  now_ += milliseconds(400);
  step();
  EXPECT_FALSE(report_.read().outputs.by_hand);
}

TEST_F(ServoLoopTest, a_hand_command_that_came_during_the_cycle_is_not_from_the_future) {
  start_servoing();
  push_hand(0.3, kPeriod + milliseconds(1));  // stamped after this cycle's time was taken
  step();
  EXPECT_TRUE(report_.read().outputs.by_hand);
}

TEST_F(ServoLoopTest, the_hand_moves_nothing_without_permit) {
  step(2);
  for (int i = 0; i < 20; ++i) {
    push_hand(0.3);
    step();
  }
  EXPECT_FALSE(drives_.enabled);
  EXPECT_EQ(drives_.largest(), 0);
}

TEST_F(ServoLoopTest, a_setpoint_that_is_no_number_never_reaches_a_motor) {
  BrokenVehicle broken;
  make(&broken);
  step(2);
  ask(Request::kArm);
  EXPECT_FALSE(drives_.enabled);
  step();
  EXPECT_EQ(state(), State::kFaulted);
  EXPECT_EQ(report_.read().supervisor.cause, Cause::kInternalFault);
}

TEST_F(ServoLoopTest, another_target_makes_the_old_ones_pose_invalid_at_once) {
  start_servoing();
  ASSERT_TRUE(report_.read().target.valid);
  SeenTarget searching;
  searching.estimate.target_id = 2;
  searching.estimate.reason = TrackReason::kNotFound;
  targets_.push(searching);
  step();
  EXPECT_FALSE(report_.read().target.valid);
  EXPECT_NE(report_.read().outputs.permit, Permit::kFull);
}

TEST_F(ServoLoopTest, a_covariance_that_is_no_number_is_no_certainty) {
  start_servoing();
  for (int i = 0; i < 10; ++i) {
    SeenTarget seen;
    seen.estimate.capture_time = now_ - milliseconds(30);
    seen.estimate.target_id = 1;
    seen.estimate.found = true;
    seen.estimate.state = TrackState::kLocked;
    seen.estimate.left_from_target.translation = {0.1, 0, 0.6};
    seen.estimate.covariance = Matrix6d::Constant(std::numeric_limits<double>::quiet_NaN());
    targets_.push(seen);
    step(10);
  }
  EXPECT_NE(report_.read().outputs.permit, Permit::kFull);
}

// What the law would have done meanwhile must not come all at once.
TEST_F(ServoLoopTest, a_hand_that_lets_go_leaves_no_leap_behind) {
  start_servoing();
  const auto lock = [&] {
    see(0.4);
    step(2);
  };
  for (int i = 0; i < 100; ++i) {
    push_hand(0);
    lock();
  }
  ASSERT_TRUE(report_.read().outputs.by_hand);
  for (int i = 0; i < 200 && report_.read().outputs.by_hand; ++i) lock();
  ASSERT_FALSE(report_.read().outputs.by_hand);
  const double first = drives_.largest();
  for (int i = 0; i < 50; ++i) lock();
  EXPECT_LT(first, 0.5 * drives_.largest());
}

TEST_F(ServoLoopTest, too_many_overruns_are_a_fault) {
  start_servoing();
  now_ += 30 * kPeriod;
  sut_->step(now_, 29);
  EXPECT_EQ(report_.read().overruns, 29u);
  EXPECT_EQ(report_.read().supervisor.cause, Cause::kOverruns);
}

TEST_F(ServoLoopTest, a_new_goal_holds_from_the_next_cycle_on) {
  start_servoing();
  servo::ServoParams params;
  params.goal_x_m = 0.1;
  params.goal_z_m = 0.6;
  params_.write(params);
  see(0.1);
  step();
  EXPECT_LT(report_.read().error.position_m.norm(), 0.05);
}

TEST_F(ServoLoopTest, without_a_vehicle_there_are_poses_and_no_arming) {
  vehicle_ = std::move(*vehicle::create_vehicle({}));
  make(vehicle_.get());
  step(2);
  for (int i = 0; i < 4; ++i) {
    see(0.1);
    step(2);
  }
  EXPECT_TRUE(report_.read().target.valid);
  EXPECT_NEAR(report_.read().target.left_from_target.translation.x(), 0.1, 1e-3);
  ask(Request::kArm);
  EXPECT_EQ(report_.read().refused, Cause::kNoVehicle);
  EXPECT_EQ(state(), State::kStandby);
}

TEST_F(ServoLoopTest, each_estimate_is_timed_once_to_the_bus) {
  start_servoing();
  const auto before = report_.read().frame_to_can.total();
  see(0.1);
  step(5);
  EXPECT_EQ(report_.read().frame_to_can.total(), before + 1);
  EXPECT_EQ(report_.read().exposure_to_can.total(), before + 1);
}

TEST_F(ServoLoopTest, the_end_of_the_program_stops_the_motors) {
  start_servoing();
  sut_->shut_down(now_ + kPeriod);
  EXPECT_FALSE(drives_.enabled);
  EXPECT_EQ(drives_.largest(), 0);
}

TEST_F(ServoLoopTest, tells_every_change_of_state_once) {
  start_servoing();
  int changes = 0;
  for (Event event; events_.take(event);) changes += event.code == telemetry::kStateChanged;
  EXPECT_EQ(changes, 3);  // standby, armed, servoing
  EXPECT_EQ(word_of("state", 3), "servoing");
}

}  // namespace
}  // namespace gannet::daemon
