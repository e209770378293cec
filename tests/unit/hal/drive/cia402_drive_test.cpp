#include "hal/drive/cia402_drive.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "platform/base/random.hpp"
#include "tests/unit/hal/drive/frames.hpp"

namespace gannet::hal {
namespace {

using std::chrono::milliseconds;

constexpr Duration kCycle = milliseconds(5);

DriveConfig config_of(std::vector<int> nodes) {
  DriveConfig config;
  config.kind = "cia402";
  config.own_node_id = 10;
  for (const int node : nodes) {
    config.motors.push_back({.node_id = node, .full_speed_rad_s = 104.71975511965978});  // 1000 rpm
  }
  return config;
}

// A drive that takes every write and reads back what was written, in the texts of its frames.
class Echo {
 public:
  explicit Echo(int node) : node_(node) {
    values_[{0x1000, 0}] = {0x00020192, 4};
    values_[{0x6061, 0}] = {3, 1};
    values_[{0x6075, 0}] = {2000, 4};
  }
  // The answer to a request, if it is one.
  std::optional<CanFrame> answer(const CanFrame& request) {
    if (request.id != 0x600u + static_cast<unsigned>(node_)) return {};
    const auto key = std::pair(request.data[1] | request.data[2] << 8, int{request.data[3]});
    CanFrame frame = {.id = 0x580u + static_cast<unsigned>(node_), .length = 8};
    std::copy_n(request.data.begin() + 1, 3, frame.data.begin() + 1);
    if (request.data[0] == 0x40) {
      const auto [value, bytes] = values_[key];
      frame.data[0] = static_cast<std::uint8_t>(bytes == 1 ? 0x4F : bytes == 2 ? 0x4B : 0x43);
      for (int i = 0; i < 4; ++i) {
        frame.data[static_cast<std::size_t>(4 + i)] = static_cast<std::uint8_t>(value >> 8 * i);
      }
    } else {
      const int bytes = request.data[0] == 0x2F ? 1 : request.data[0] == 0x2B ? 2 : 4;
      std::uint32_t value = 0;
      for (int i = 3; i >= 0; --i)
        value = value << 8 | request.data[static_cast<std::size_t>(4 + i)];
      values_[key] = {value, bytes};
      frame.data[0] = 0x60;
    }
    return frame;
  }

 private:
  int node_;
  std::map<std::pair<int, int>, std::pair<std::uint32_t, int>> values_;
};

class Cia402DriveTest : public testing::Test {
 protected:
  void make(const DriveConfig& config) {
    sut_ = std::move(Cia402Drive::create(config)).value();
    setpoints_.assign(config.motors.size(), {});
  }
  void hear(const char* text) { sut_->receive(frames_from({text}).front(), now_); }
  Texts send(bool enable = false) {
    now_ += kCycle;
    CanFrame out[64];
    const int n = sut_->send(setpoints_, enable, now_, out);
    EXPECT_LE(n, sut_->max_frames());
    sent_.assign(out, out + n);
    return texts_of(sent_);
  }
  // Sets up node 0x15 against an Echo; returns what was said to it alone.
  Texts set_up() {
    Echo echo(0x15);
    Texts said;
    for (int i = 0; i < 200; ++i) {
      for (const std::string& text : send()) {
        const bool is_cyclic = text == "080#" || text == "70A#05";
        if (!is_cyclic) said.push_back(text);
      }
      if (said.back() == "000#0115") break;
      for (const CanFrame& frame : sent_) {
        if (const auto answer = echo.answer(frame)) sut_->receive(*answer, now_);
      }
    }
    return said;
  }
  void start() {
    make(config_of({0x15}));
    set_up();
    hear("715#05");
    hear("195#5002000000000000");
  }

  std::unique_ptr<Cia402Drive> sut_;
  std::vector<DriveSetpoint> setpoints_;
  std::vector<CanFrame> sent_;
  TimePoint now_ = time_from_ns(1'000'000'000);
};

TEST_F(Cia402DriveTest, SetsADriveUpWithTheseFrames) {
  make(config_of({0x15}));
  EXPECT_EQ(set_up(), (Texts{
                          "000#8015",              // NMT pre-operational
                          "615#4000100000000000",  // device type?
                          "615#2B40600002000000",  // quick stop, whatever it did
                          "615#2B17100064000000",  // its heartbeat: 100 ms
                          "615#2300140115020080",  // RPDO 1 off
                          "615#2F00160000000000",  //
                          "615#2300160110004060",  // control word
                          "615#230016022000FF60",  // target velocity
                          "615#2F00160002000000",  //
                          "615#2F001402FF000000",  // taken at once
                          "615#2300140115020000",  // on, 0x215
                          "615#4000160000000000",  // and read back
                          "615#4000160100000000",  //
                          "615#4000160200000000",  //
                          "615#4000140200000000",  //
                          "615#4000140100000000",  //
                          "615#23001801950100C0",  // TPDO 1 off
                          "615#2F001A0000000000",  //
                          "615#23001A0110004160",  // status word
                          "615#23001A0220006C60",  // actual velocity
                          "615#23001A0310007860",  // actual current
                          "615#2F001A0003000000",  //
                          "615#2F00180201000000",  // at each SYNC
                          "615#2300180195010040",  // on, 0x195, no RTR
                          "615#40001A0000000000",  // and read back
                          "615#40001A0100000000",  //
                          "615#40001A0200000000",  //
                          "615#40001A0300000000",  //
                          "615#4000180200000000",  //
                          "615#4000180100000000",  //
                          "615#23011801950200C0",  // TPDO 2 to 4 off
                          "615#23021801950300C0",  //
                          "615#23031801950400C0",  //
                          "615#2F60600003000000",  // profile velocity
                          "615#4061600000000000",  // is it?
                          "615#2B5A600002000000",  // a quick stop ends switched off
                          "615#2306100088130000",  // SYNC each 5000 us
                          "615#4075600000000000",  // rated current?
                          "615#23161001C8000A00",  // watch node 10's heartbeat: 200 ms
                          "615#4016100100000000",  //
                          "615#2F29100100000000",  // its loss: pre-operational
                          "615#2B07600003000000",  // and a quick stop
                          "615#4007600000000000",  //
                          "000#0115",              // NMT start
                      }));
  EXPECT_FALSE(sut_->health(now_).all_ready);  // it has not said that it is operational
  hear("715#05");
  EXPECT_FALSE(sut_->health(now_).all_ready);  // nor in which state
  hear("195#5002000000000000");
  EXPECT_TRUE(sut_->health(now_).all_ready);
  EXPECT_TRUE(sut_->health(now_).guards_itself);
}

TEST_F(Cia402DriveTest, SaysInACycleSetpointsThenSyncThenHeartbeat) {
  start();
  EXPECT_EQ(send(true), (Texts{"215#060000000000", "080#"}));  // shutdown
  hear("195#3102000000000000");
  EXPECT_EQ(send(true), (Texts{"215#070000000000", "080#"}));  // switch on
  hear("195#3302000000000000");
  setpoints_[0].value = 0.5;
  EXPECT_EQ(send(true).front(), "215#0F0000000000");  // enable operation, no target yet
  hear("195#3702000000000000");
  EXPECT_EQ(send(true).front(), "215#0F00F4010000");  // 500 rpm
  setpoints_[0].value = -1;
  EXPECT_EQ(send(true).front(), "215#0F0018FCFFFF");
  setpoints_[0].value = 7;
  EXPECT_EQ(send(true).front(), "215#0F00E8030000");  // beyond: full
  setpoints_[0].value = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(send(true).front(), "215#0F0100000000");  // halt
  setpoints_[0].value = 0.5;
  EXPECT_EQ(send(false).front(), "215#020000000000");  // quick stop, whatever the setpoint says
  hear("195#1702E80300000000");
  EXPECT_EQ(send(false).front(), "215#020000000000");
  hear("195#5002000000000000");
  EXPECT_EQ(send(false).front(), "215#000000000000");
}

TEST_F(Cia402DriveTest, BeatsOnItsOwnRaster) {
  make(config_of({0x15}));
  std::vector<int> beats;
  for (int i = 0; i < 60; ++i) {
    const Texts texts = send();
    if (std::find(texts.begin(), texts.end(), "70A#05") != texts.end()) beats.push_back(i);
  }
  EXPECT_EQ(beats, (std::vector<int>{0, 10, 20, 30, 40, 50}));
}

TEST_F(Cia402DriveTest, ReadsFeedbackOfAPdo) {
  start();
  hear("195#37169CFFFFFFF401");  // −100 rpm, half the rated 2 A
  send(true);
  const DriveFeedback& f = sut_->feedback()[0];
  EXPECT_NEAR(f.speed_rad_s, -10.471975511965978, 1e-9);
  EXPECT_NEAR(f.current_a, 1, 1e-9);
  EXPECT_EQ(f.state, DriveState::kEnabled);
  EXPECT_EQ(f.time, now_ - kCycle);
}

TEST_F(Cia402DriveTest, CountsWhatIsTooShortAndIgnoresWhatIsNotItsOwn) {
  start();
  hear("195#37160000");  // shorter than mapped
  hear("715#");          // no state
  hear("715#03");        // no such state
  hear("095#0000");      // EMCY of two bytes
  hear("595#");          // SDO answer of none
  EXPECT_EQ(sut_->malformed(), 5u);
  hear("196#3716");       // another node
  hear("00000195#3716");  // 29 bits
  hear("315#3716");       // another PDO
  hear("20000004#0004000000000000");
  EXPECT_EQ(sut_->malformed(), 5u);
  hear("70A#05");
  EXPECT_EQ(sut_->counters().own_id_conflicts, 1u);
}

// Its heartbeats would keep the drives content after we have died.
TEST_F(Cia402DriveTest, AnotherMasterWithOurNodeIdIsAFaultUntilItHasBeenGoneForAWhile) {
  for (const char* word : {"70A#05", "080#", "080#01"}) {
    start();
    send(false);
    ASSERT_FALSE(sut_->health(now_).any_fault);
    hear(word);
    const TimePoint heard = now_;
    const DriveGroupHealth health = sut_->health(heard + milliseconds(2000));
    EXPECT_TRUE(health.any_fault);
    EXPECT_FALSE(health.guards_itself);
    EXPECT_EQ(health.first_bad, 0);
    EXPECT_STREQ(health.trouble, "another master on the bus speaks as we do");
    EXPECT_EQ(health.trouble_code, 10u);
    EXPECT_EQ(sut_->counters().own_id_conflicts, 1u);
    EXPECT_FALSE(sut_->health(heard + milliseconds(2001)).any_fault);
  }
}

TEST_F(Cia402DriveTest, KeepsTheFaultCodeOfTheEmergencyAndItsWords) {
  start();
  hear("095#1186200200000000");
  hear("195#1802000000000000");
  send(false);
  EXPECT_EQ(sut_->feedback()[0].fault_code, 0x8611);
  EXPECT_EQ(sut_->feedback()[0].state, DriveState::kFault);
  EXPECT_STREQ(sut_->health(now_).trouble, "following error");
  sut_->reset_faults(now_);
  EXPECT_EQ(send(false).front(), "215#800000000000");
  hear("095#0000000000000000");
  hear("195#5002000000000000");
  EXPECT_EQ(send(false).front(), "215#000000000000");
  EXPECT_FALSE(sut_->health(now_).any_fault);
}

TEST_F(Cia402DriveTest, AsksAnAbsentDriveAgainAndAgainWithoutFloodingTheBus) {
  make(config_of({0x15, 0x16}));
  int frames = 0;
  for (int i = 0; i < 2000; ++i) frames += static_cast<int>(send().size());  // 10 s
  // 2000 SYNCs, 200 heartbeats; then each 0.8 s NMT, three requests and an abort for each drive.
  EXPECT_LT(frames, 2000 + 200 + 2 * 5 * 14);
  EXPECT_GT(frames, 2000 + 200 + 2 * 5 * 10);
  EXPECT_FALSE(sut_->health(now_).all_alive);
}

TEST_F(Cia402DriveTest, RefusesConfigsThatDoNotFit) {
  const auto error = [](void (*change)(DriveConfig&)) {
    DriveConfig config = config_of({0x15, 0x16});
    change(config);
    const auto made = Cia402Drive::create(config);
    return made ? "" : made.error().text;
  };
  EXPECT_EQ(error([](DriveConfig&) {}), "");
  EXPECT_NE(error([](DriveConfig& c) { c.motors.clear(); }).find("no motor"), std::string::npos);
  EXPECT_NE(error([](DriveConfig& c) { c.motors[1].node_id = 0x15; }).find("also that of motor 1"),
            std::string::npos);
  EXPECT_NE(error([](DriveConfig& c) { c.own_node_id = 0x15; }).find("is drive.own_node_id"),
            std::string::npos);
  EXPECT_NE(error([](DriveConfig& c) { c.motors[0].node_id = 128; }).find("1 to 127"),
            std::string::npos);
  EXPECT_NE(error([](DriveConfig& c) { c.motors[0].full_speed_rad_s = 1e12; }).find("full_speed"),
            std::string::npos);
  EXPECT_NE(error([](DriveConfig& c) { c.motors[0].full_speed_rad_s = 0; }).find("full_speed"),
            std::string::npos);
  EXPECT_NE(error([](DriveConfig& c) { c.cia402.guard_time_s = 0.06; }).find("guard_time_s"),
            std::string::npos);
  EXPECT_NE(error([](DriveConfig& c) { c.cia402.node_timeout_s = 0.1; }).find("node_timeout_s"),
            std::string::npos);
  EXPECT_NE(error([](DriveConfig& c) { c.cia402.heartbeat_period_s = 0.001; }).find("servo cycle"),
            std::string::npos);
}

TEST_F(Cia402DriveTest, WantsTheFramesOfItsNodesAlone) {
  const auto filters = Cia402Drive::wanted_frames(config_of({0x15}));
  const auto wants = [&](const char* text) {
    const CanFrame frame = frames_from({text}).front();
    return std::any_of(filters.begin(), filters.end(),
                       [&](const CanFilter& f) { return f.matches(frame); });
  };
  for (const char* text : {"095#00", "195#00", "595#00", "715#00", "70A#05", "080#"}) {
    EXPECT_TRUE(wants(text)) << text;
  }
  for (const char* text : {"000#0100", "215#00", "295#00", "615#00", "196#00", "00000195#"}) {
    EXPECT_FALSE(wants(text)) << text;
  }
}

TEST_F(Cia402DriveTest, SaysTheCycleTimeInTheCoarsestDecimalsThatFit) {
  struct Case {
    double period_s;
    const char *value, *index;
  };
  for (const Case& c : {Case{0.005, "05", "FD"}, Case{0.0025, "19", "FC"}, Case{0.02, "14", "FD"},
                        Case{1.0 / 150, "43", "FC"}}) {
    DriveConfig config = config_of({0x15});
    config.cia402.mode = "cyclic_velocity";
    config.cia402.servo_period_s = c.period_s;
    Texts said;
    for (const cia402::SetupStep& step : cia402::setup_steps(config.cia402, 0x15, 10)) {
      if (step.object.index == 0x60C2) {
        said.push_back(
            to_text(canopen::sdo_write_request(0x15, step.object, step.value, step.bytes)));
      }
    }
    EXPECT_EQ(said, (Texts{std::string("615#2FC26001") + c.value + "000000",
                           std::string("615#2FC26002") + c.index + "000000"}));
  }
}

// Any frames at any time, most of them nearly right ones.
TEST_F(Cia402DriveTest, SurvivesMutatedFramesAndNeverRunsWithoutEnable) {
  make(config_of({0x15, 0x16, 0x17}));
  Echo echo(0x15);
  Random random(99);
  const Texts seeds = {"715#00",
                       "715#05",
                       "715#7F",
                       "195#3706000000000000",
                       "195#0800000000000000",
                       "095#1043010000000000",
                       "595#4300100092010200",
                       "595#6000140100000000",
                       "595#8000140100000206",
                       "716#05"};
  const std::vector<CanFrame> frames = frames_from(seeds);
  for (int i = 0; i < 20000; ++i) {
    const bool enable = random.below(3) == 0;
    for (const DriveFeedback& f : sut_->feedback()) ASSERT_TRUE(std::isfinite(f.speed_rad_s));
    for (DriveSetpoint& s : setpoints_) s.value = random.uniform() * 2 - 1;
    send(enable);
    for (const CanFrame& frame : sent_) {
      const bool is_setpoint = (frame.id & 0x780) == 0x200;
      if (is_setpoint && !enable) {
        ASSERT_NE(frame.data[0] & 0x0F, 0x0F);
      }
      const auto answer = echo.answer(frame);
      if (answer && random.below(50) != 0) sut_->receive(*answer, now_);
    }
    for (int k = 0; k < 3; ++k) {
      CanFrame frame =
          frames[static_cast<std::size_t>(random.below(static_cast<int>(frames.size())))];
      if (random.below(2) == 0) {
        frame.data[static_cast<std::size_t>(random.below(8))] =
            static_cast<std::uint8_t>(random.next());
      }
      if (random.below(8) == 0) frame.length = static_cast<std::uint8_t>(random.below(16));
      if (random.below(8) == 0)
        frame.id = static_cast<std::uint32_t>(random.next()) & kMaxExtendedId;
      sut_->receive(frame, now_);
    }
    sut_->health(now_);
    if (random.below(100) == 0) sut_->reset_faults(now_);
  }
}

}  // namespace
}  // namespace gannet::hal
