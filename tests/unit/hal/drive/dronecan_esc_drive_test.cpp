#include "hal/drive/dronecan_esc_drive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "hal/drive/drive_kinds.hpp"
#include "platform/base/random.hpp"
#include "tests/unit/hal/drive/frames.hpp"

namespace gannet::hal {
namespace {

using namespace dronecan;
using std::chrono::milliseconds;

constexpr TimePoint at_ms(std::int64_t ms) { return TimePoint(milliseconds(ms)); }
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

DriveConfig with_motors(int motors) {
  DriveConfig config;
  config.dronecan.esc_timeout_s = 0.5;
  for (int i = 0; i < motors; ++i) config.motors.push_back({.index = i, .node_id = 21 + i});
  return config;
}

class DroneCanEscDriveTest : public testing::Test {
 protected:
  void make(const DriveConfig& config) {
    auto made = DroneCanEscDrive::create(config);
    ASSERT_TRUE(made) << made.error().text;
    sut_ = std::move(*made);
  }
  std::vector<CanFrame> send(const std::vector<double>& values, bool enable, TimePoint now) {
    std::vector<DriveSetpoint> setpoints;
    for (double value : values) setpoints.push_back({value});
    std::vector<CanFrame> out(static_cast<std::size_t>(sut_->max_frames()));
    out.resize(static_cast<std::size_t>(sut_->send(setpoints, enable, now, out)));
    return out;
  }
  // The messages of one type among what is sent.
  template <class Message>
  std::vector<Message> messages(std::span<const CanFrame> frames,
                                TransferKind kind = TransferKind::kMessage, int to = 0) {
    TransferReceiver receiver({subscription_to<Message>(kind)}, to);
    std::vector<Message> found;
    for (const CanFrame& frame : frames) {
      if (const auto transfer = receiver.receive(frame, {})) {
        EXPECT_TRUE(decode(transfer->payload, found.emplace_back()));
      }
    }
    return found;
  }
  std::vector<int> commands(const std::vector<double>& values, bool enable, TimePoint now) {
    const auto found = messages<RawCommand>(send(values, enable, now));
    EXPECT_EQ(found.size(), 1u);
    if (found.empty()) return {};
    return {found[0].commands.begin(), found[0].commands.end()};
  }
  template <class Message>
  void hear(const Message& message, int source, TimePoint time) {
    CanFrame frames[64];
    const int n = to_frames(message,
                            {.type_id = Message::kType.id,
                             .source = static_cast<std::uint8_t>(source),
                             .transfer_id = ids_[source]++},
                            frames);
    ids_[source] %= 32;
    for (int i = 0; i < n; ++i) sut_->receive(frames[i], time);
  }
  void hear_well(int motors, TimePoint time) {
    for (int i = 0; i < motors; ++i) {
      hear(NodeStatus{}, 21 + i, time);
      hear(EscStatus{.esc_index = static_cast<std::uint8_t>(i)}, 21 + i, time);
    }
  }
  std::unique_ptr<DroneCanEscDrive> sut_;
  std::array<std::uint8_t, 128> ids_ = {};
};

TEST_F(DroneCanEscDriveTest, FirstCycleAsCandumpShowsIt) {
  make(with_motors(6));
  EXPECT_EQ(texts_of(send({1, -1, 0.5, 0, 0, 0}, true, at_ms(0))),
            (Texts{"0804060A#1C2FFF7C06000480", "0804060A#00000000000060",  // RawCommand
                   "10044C0A#FFC0",                                         // armed
                   "1001550A#00000000000000C0"}));                          // heartbeat
}

TEST_F(DroneCanEscDriveTest, CommandsEveryMotorInOneTransfer) {
  make(with_motors(8));
  EXPECT_EQ(commands({1, -1, 0.5, 0, 2, -2, 0.001, kNan}, true, at_ms(0)),
            (std::vector<int>{8191, -8191, 4096, 0, 8191, -8191, 8, 0}));
  EXPECT_EQ(sut_->counters().bad_setpoints, 1u);
}

TEST_F(DroneCanEscDriveTest, NotEnabledCommandsStopInEachCycleWhateverSetpointsSay) {
  make(with_motors(3));
  for (int cycle = 0; cycle < 3; ++cycle) {
    EXPECT_EQ(commands({1, -1, 0.5}, false, at_ms(5 * cycle)), (std::vector<int>{0, 0, 0}));
  }
}

TEST_F(DroneCanEscDriveTest, AMissingSetpointStopsThatMotor) {
  make(with_motors(3));
  EXPECT_EQ(commands({1}, true, at_ms(0)), (std::vector<int>{8191, 0, 0}));
  EXPECT_EQ(sut_->counters().bad_setpoints, 2u);
}

TEST_F(DroneCanEscDriveTest, IndexSignAndLimitAreTheMotors) {
  DriveConfig config;
  config.motors = {{.index = 3, .node_id = 21, .reversed = true},
                   {.index = 0, .node_id = 22, .max_command = 0.5}};
  make(config);
  EXPECT_EQ(commands({1, 1}, true, at_ms(0)), (std::vector<int>{4096, 0, 0, -8191}));
}

TEST_F(DroneCanEscDriveTest, ForwardOnlyEscsAreNeverCommandedBackwards) {
  DriveConfig config = with_motors(2);
  config.range = "forward_only";
  make(config);
  EXPECT_EQ(commands({-1, 0.25}, true, at_ms(0)), (std::vector<int>{0, 2048}));
}

TEST_F(DroneCanEscDriveTest, CentredPwmStopsInTheMiddleAlsoOnUnusedIndices) {
  DriveConfig config;
  config.range = "pwm_centred";
  config.motors = {{.index = 0, .node_id = 21}, {.index = 2, .node_id = 21}};
  make(config);
  EXPECT_EQ(commands({1, -1}, false, at_ms(0)), (std::vector<int>{4096, 4096, 4096}));
  EXPECT_EQ(commands({1, -1}, true, at_ms(1)), (std::vector<int>{8191, 4096, 1}));
}

TEST_F(DroneCanEscDriveTest, ALongerCommandPeriodDoesNotDelayAStop) {
  DriveConfig config = with_motors(1);
  config.command_period_s = 0.02;
  make(config);
  int sent = 0;
  for (int ms = 0; ms < 200; ms += 5) {
    sent += static_cast<int>(messages<RawCommand>(send({1}, true, at_ms(ms))).size());
  }
  EXPECT_EQ(sent, 10);
  EXPECT_EQ(commands({1}, false, at_ms(205)), std::vector<int>{0});  // 180, then 200 was due: sent
  // A bus that refuses one must not delay it by a period.
  for (int ms = 210; ms <= 505; ms += 5) {
    EXPECT_EQ(commands({1}, false, at_ms(ms)), std::vector<int>{0});
  }
  sent = 0;
  for (int ms = 510; ms < 710; ms += 5) {
    sent += static_cast<int>(messages<RawCommand>(send({1}, false, at_ms(ms))).size());
  }
  EXPECT_EQ(sent, 10);
  EXPECT_EQ(commands({1}, true, at_ms(715)), std::vector<int>{8191});
}

TEST_F(DroneCanEscDriveTest, HeartbeatOnceASecondWithUptime) {
  make(with_motors(1));
  std::vector<std::uint32_t> uptimes;
  for (int ms = 500; ms <= 5500; ms += 7) {
    for (const auto& status : messages<NodeStatus>(send({0}, false, at_ms(ms)))) {
      uptimes.push_back(status.uptime_s);
      EXPECT_EQ(status.mode, NodeStatus::kOperational);
    }
  }
  EXPECT_EQ(uptimes, (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
}

TEST_F(DroneCanEscDriveTest, ArmingStatusTwiceASecondAndAtOnceAtAChange) {
  make(with_motors(1));
  const auto status = [&](bool enable, int ms) {
    const auto found = messages<dronecan::ArmingStatus>(send({0}, enable, at_ms(ms)));
    return found.empty() ? -1 : found[0].status;
  };
  EXPECT_EQ(status(false, 0), 0);
  EXPECT_EQ(status(false, 100), -1);
  EXPECT_EQ(status(false, 500), 0);
  EXPECT_EQ(status(true, 505), 255);
  EXPECT_EQ(status(true, 510), -1);
  EXPECT_EQ(status(false, 515), 0);
}

TEST_F(DroneCanEscDriveTest, ArmingStatusCanBeLeftOut) {
  DriveConfig config = with_motors(1);
  config.arming_status = false;
  make(config);
  EXPECT_TRUE(messages<dronecan::ArmingStatus>(send({0}, true, at_ms(0))).empty());
}

TEST_F(DroneCanEscDriveTest, FeedbackHasUnitsSignAndPolePairs) {
  DriveConfig config;
  config.motors = {{.index = 0, .node_id = 21},
                   {.index = 5, .node_id = 22, .reversed = true, .pole_pairs = 7}};
  make(config);
  for (const CanFrame& frame :  // −12345 rpm, 15.5 V, −2.25 A, 310.5 K, 70000 errors, index 5
       frames_from({"10040A16#B99E70110100C08C", "10040A16#4B80C0DA5CC7CF2C", "10040A16#DB944C"})) {
    sut_->receive(frame, at_ms(40));
  }
  const DriveFeedback& feedback = sut_->feedback()[1];
  EXPECT_EQ(feedback.time, at_ms(40));
  EXPECT_NEAR(feedback.speed_rad_s, 12345 / 7.0 * 2 * std::numbers::pi / 60, 1e-9);
  EXPECT_EQ(feedback.voltage_v, 15.5);
  EXPECT_EQ(feedback.current_a, -2.25);
  EXPECT_EQ(feedback.temperature_k, 310.5);
  EXPECT_EQ(feedback.error_count, 70000u);
  EXPECT_EQ(sut_->feedback()[0].time, TimePoint{});
}

TEST_F(DroneCanEscDriveTest, StatusUnderAWrongNodeIsNotBelieved) {
  make(with_motors(2));
  hear(EscStatus{.rpm = 100, .esc_index = 0}, 22, at_ms(1));
  EXPECT_EQ(sut_->feedback()[0].speed_rad_s, 0);
  EXPECT_EQ(sut_->counters().foreign_status, 1u);
}

TEST_F(DroneCanEscDriveTest, AliveNeedsHeartbeatAndFreshFeedback) {
  make(with_motors(2));
  EXPECT_FALSE(sut_->health(at_ms(0)).all_alive);
  hear_well(2, at_ms(0));
  EXPECT_TRUE(sut_->health(at_ms(500)).all_alive);
  EXPECT_EQ(sut_->health(at_ms(500)).first_bad, -1);
  hear(EscStatus{.esc_index = 0}, 21, at_ms(400));
  EXPECT_FALSE(sut_->health(at_ms(501)).all_alive);
  EXPECT_EQ(sut_->health(at_ms(501)).first_bad, 1);
}

TEST_F(DroneCanEscDriveTest, ANodeWithoutHeartbeatIsOfflineAfterThreeSeconds) {
  make(with_motors(1));
  hear_well(1, at_ms(0));
  for (int ms = 0; ms <= 3200; ms += 100) hear(EscStatus{}, 21, at_ms(ms));
  EXPECT_TRUE(sut_->health(at_ms(3000)).all_alive);
  EXPECT_FALSE(sut_->health(at_ms(3001)).all_alive);
}

TEST_F(DroneCanEscDriveTest, APwmEscWithoutFeedbackLivesByItsNodesHeartbeat) {
  DriveConfig config = with_motors(1);
  config.motors[0].has_feedback = false;
  make(config);
  hear(NodeStatus{}, 21, at_ms(0));
  EXPECT_TRUE(sut_->health(at_ms(2500)).all_alive);
}

TEST_F(DroneCanEscDriveTest, StatesFollowEnableLifeAndFaults) {
  make(with_motors(1));
  const auto state = [&](bool enable, int ms) {
    send({0}, enable, at_ms(ms));
    return sut_->feedback()[0].state;
  };
  EXPECT_EQ(state(false, 0), DriveState::kUnknown);
  hear_well(1, at_ms(1));
  EXPECT_EQ(state(false, 2), DriveState::kDisabled);
  EXPECT_EQ(state(true, 3), DriveState::kEnabled);
  hear(NodeStatus{.health = NodeStatus::kWarning}, 21, at_ms(4));
  EXPECT_EQ(state(true, 5), DriveState::kEnabled);
  hear(NodeStatus{.health = NodeStatus::kCritical, .vendor_status = 77}, 21, at_ms(6));
  EXPECT_EQ(state(true, 7), DriveState::kFault);
  EXPECT_EQ(sut_->feedback()[0].fault_code, 77);
  EXPECT_TRUE(sut_->health(at_ms(7)).any_fault);
  hear(NodeStatus{.mode = NodeStatus::kSoftwareUpdate}, 21, at_ms(8));
  EXPECT_EQ(state(true, 9), DriveState::kFault);
  EXPECT_EQ(sut_->feedback()[0].fault_code, NodeWatch::kNoVendorStatus);
  hear(NodeStatus{}, 21, at_ms(10));
  EXPECT_EQ(state(true, 11), DriveState::kEnabled);
  EXPECT_EQ(sut_->feedback()[0].fault_code, 0);
}

// Its ESC must not go on by itself with what is commanded then.
TEST_F(DroneCanEscDriveTest, ANodeThatRestartsWhileEnabledIsFaultyUntilEnableIsTakenAway) {
  make(with_motors(2));
  hear_well(2, at_ms(0));
  hear(NodeStatus{.uptime_s = 100}, 22, at_ms(1));
  hear(NodeStatus{.uptime_s = 1}, 22, at_ms(2));  // not enabled: as good as any start
  send({}, false, at_ms(3));
  EXPECT_FALSE(sut_->health(at_ms(3)).any_fault);
  send({1, 1}, true, at_ms(5));
  hear(NodeStatus{.uptime_s = 0}, 22, at_ms(6));
  send({1, 1}, true, at_ms(10));
  hear(NodeStatus{.uptime_s = 1}, 22, at_ms(11));
  send({1, 1}, true, at_ms(15));
  const DriveGroupHealth health = sut_->health(at_ms(15));
  EXPECT_TRUE(health.any_fault);
  EXPECT_EQ(health.first_bad, 1);
  EXPECT_STREQ(health.trouble, "its node restarted while enabled");
  EXPECT_EQ(sut_->feedback()[1].state, DriveState::kFault);
  EXPECT_EQ(sut_->feedback()[1].fault_code, NodeWatch::kRestarted);
  EXPECT_EQ(commands({1, 1}, true, at_ms(20)), (std::vector<int>{8191, 0}));
  send({}, false, at_ms(25));
  EXPECT_FALSE(sut_->health(at_ms(25)).any_fault);
  EXPECT_EQ(commands({1, 1}, true, at_ms(30)), (std::vector<int>{8191, 8191}));
}

TEST_F(DroneCanEscDriveTest, ANodeThatSaysOfflineIsNotAlive) {
  make(with_motors(1));
  hear_well(1, at_ms(0));
  hear(NodeStatus{.mode = NodeStatus::kOffline}, 21, at_ms(1));
  EXPECT_FALSE(sut_->health(at_ms(2)).all_alive);
}

TEST_F(DroneCanEscDriveTest, AsksEachNodeWhoItIsUntilItAnswers) {
  make(with_motors(1));
  const auto requests = [&](int ms) {
    int n = 0;
    for (const CanFrame& frame : send({0}, false, at_ms(ms))) {
      const auto header = header_of(frame);
      n += header && header->kind == TransferKind::kRequest && header->destination == 21;
    }
    return n;
  };
  EXPECT_EQ(requests(0), 0);  // nobody there yet
  hear(NodeStatus{.uptime_s = 9}, 21, at_ms(1));
  EXPECT_EQ(requests(2), 1);
  EXPECT_EQ(requests(1001), 0);
  EXPECT_EQ(requests(1002), 1);
  for (const CanFrame& frame : frames_from(
           {"18010A95#95754D0000000084", "18010A95#0000010201EFBE24", "18010A95#ADDEEFCDAB896704",
            "18010A95#4523010304000124", "18010A95#0203040506070804", "18010A95#090A0B0C0D0E0F24",
            "18010A95#0209086F72672E04", "18010A95#6578616D706C6524", "18010A95#2E65736344"})) {
    sut_->receive(frame, at_ms(1010));
  }
  ASSERT_TRUE(sut_->nodes()[0].has_info);
  EXPECT_EQ(sut_->nodes()[0].info.hardware_major, 3);
  EXPECT_EQ(requests(2500), 0);
  hear(NodeStatus{.uptime_s = 0}, 21, at_ms(2600));  // restarted: perhaps another device
  EXPECT_EQ(sut_->nodes()[0].restarts, 1u);
  EXPECT_EQ(requests(2601), 1);
}

TEST_F(DroneCanEscDriveTest, AnswersWhoAsks) {
  make(with_motors(1));
  sut_->receive(frames_from({"18018AFF#D1"})[0], at_ms(0));  // node 127 asks node 10, id 17
  const auto frames = send({0}, false, at_ms(3000));
  const auto infos = messages<NodeInfo>(frames, TransferKind::kResponse, 127);
  ASSERT_EQ(infos.size(), 1u);
  EXPECT_EQ(std::string(infos[0].name.begin(), infos[0].name.end()), "org.gannet.daemon");
  EXPECT_EQ(header_of(frames.back())->transfer_id, 17);
  EXPECT_TRUE(
      messages<NodeInfo>(send({0}, false, at_ms(3005)), TransferKind::kResponse, 127).empty());
}

TEST_F(DroneCanEscDriveTest, AllocationRequestsAreCountedAndShown) {
  make(with_motors(1));
  sut_->receive(frames_from({"1048D100#65010203040506C1"})[0], at_ms(0));
  EXPECT_EQ(sut_->counters().allocation_requests, 1u);
  ASSERT_EQ(sut_->last_allocation_id().size(), 6u);
  EXPECT_EQ(sut_->last_allocation_id()[5], 6);
}

TEST_F(DroneCanEscDriveTest, AnotherNodeUnderOurIdIsAFaultUntilItHasBeenGoneForAWhile) {
  make(with_motors(1));
  hear_well(1, at_ms(0));
  EXPECT_FALSE(sut_->health(at_ms(1)).any_fault);
  sut_->receive(frames_from({"1001550A#00000000000000C0"})[0], at_ms(10));
  EXPECT_EQ(sut_->counters().own_id_conflicts, 1u);
  const DriveGroupHealth health = sut_->health(at_ms(2010));
  EXPECT_TRUE(health.any_fault);
  EXPECT_EQ(health.first_bad, 0);
  EXPECT_STREQ(health.trouble, "another node on the bus has our node id");
  EXPECT_EQ(health.trouble_code, 10u);
  EXPECT_FALSE(sut_->health(at_ms(2011)).any_fault);
}

TEST_F(DroneCanEscDriveTest, EscsOfWhichNobodyKnowsWhetherTheyStopAreUnguarded) {
  DriveConfig config = with_motors(2);
  config.dronecan.esc_timeout_s = 0;
  make(config);
  hear_well(2, at_ms(0));
  DriveGroupHealth health = sut_->health(at_ms(1));
  EXPECT_FALSE(health.guards_itself);
  EXPECT_EQ(health.first_bad, 0);
  EXPECT_NE(std::string(health.trouble).find("esc_timeout_s"), std::string::npos);
  config.dronecan.accept_unguarded = true;
  make(config);
  hear_well(2, at_ms(0));
  EXPECT_TRUE(sut_->health(at_ms(1)).guards_itself);
  make(with_motors(2));
  EXPECT_TRUE(sut_->health(at_ms(1)).guards_itself) << "the config's word, heard or not";
}

TEST_F(DroneCanEscDriveTest, TheMostFramesSufficeForTwentyMotorsAndAllDuties) {
  make(with_motors(20));
  for (int i = 0; i < 20; ++i) hear(NodeStatus{}, 21 + i, at_ms(0));
  sut_->receive(frames_from({"18018AFF#D1"})[0], at_ms(0));
  const auto frames = send(std::vector<double>(20, 1.0), true, at_ms(1));
  EXPECT_EQ(messages<RawCommand>(frames).at(0).commands.size(), 20);
  EXPECT_EQ(messages<NodeInfo>(frames, TransferKind::kResponse, 127).size(), 1u);
  EXPECT_EQ(header_of(frames.back())->kind, TransferKind::kRequest);
  EXPECT_LT(static_cast<int>(frames.size()), sut_->max_frames());
}

TEST_F(DroneCanEscDriveTest, TooLittleRoomLeavesOutWholeMessages) {
  make(with_motors(8));
  std::vector<CanFrame> out(2);
  const DriveSetpoint none[8] = {};
  const int n = sut_->send(none, true, at_ms(0), out);
  for (int i = 0; i < n; ++i) {
    EXPECT_NE(header_of(out[static_cast<std::size_t>(i)])->type_id, RawCommand::kType.id);
  }
}

TEST_F(DroneCanEscDriveTest, ItsFiltersPassWhatItListensToAndLittleElse) {
  const DriveConfig config = with_motors(1);
  const auto filters = wanted_frames(config);
  const auto is_wanted = [&](const char* text) {
    const CanFrame frame = frames_from({text})[0];
    return std::any_of(filters.begin(), filters.end(),
                       [&](const CanFilter& f) { return f.matches(frame); });
  };
  for (const char* text :
       {"10040A15#C0", "10015515#C0", "1048D100#C0", "18010A95#C0", "18018AFF#C0"}) {
    EXPECT_TRUE(is_wanted(text)) << text;
  }
  for (const char* text : {"0804060A#C0", "10044C0A#C0", "18010B95#C0", "100409FF#C0", "123#C0"}) {
    EXPECT_FALSE(is_wanted(text)) << text;
  }
}

TEST_F(DroneCanEscDriveTest, SurvivesRandomAndMutatedFrames) {
  make(with_motors(4));
  Random random(5);
  const auto good = frames_from({"10040A15#B99E70110100C08C", "10040A15#4B80C0DA5CC7CF2C",
                                 "10040A15#DB944C", "10015515#40E201008DEFBEC7", "18018AFF#D1",
                                 "18010A95#95754D0000000084", "1048D100#65010203040506C1"});
  for (int i = 0; i < 10000; ++i) {
    CanFrame frame = good[static_cast<std::size_t>(random.below(static_cast<int>(good.size())))];
    if (random.below(3) > 0) {
      frame.data[static_cast<std::size_t>(random.below(8))] =
          static_cast<std::uint8_t>(random.next());
    }
    if (random.below(4) == 0) frame.length = static_cast<std::uint8_t>(random.below(9));
    if (random.below(8) == 0) frame.id = static_cast<std::uint32_t>(random.next()) & kMaxExtendedId;
    sut_->receive(frame, at_ms(i));
    const auto sent = send({kNan, 1e300, -1e300, 0}, true, at_ms(i));
    const auto found = messages<RawCommand>(sent);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].commands[1], 8191);
    EXPECT_EQ(found[0].commands[2], -8191);
  }
  EXPECT_GT(sut_->malformed(), 100u);
}

}  // namespace
}  // namespace gannet::hal
