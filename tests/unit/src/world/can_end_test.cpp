#include "src/world/can_end.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <vector>

#include "hal/can/bus_health.hpp"
#include "hal/can/local_bus.hpp"

namespace gannet::world {
namespace {

constexpr TimePoint kNow = time_from_ns(1'000'000'000);
constexpr hal::CanFrame kFrame = {.id = 0x123, .length = 1, .data = {7}};

// The daemon's side of a vcan, as far as the world can tell.
class PlayedVcan final : public hal::CanBus {
 public:
  int send(std::span<const hal::CanFrame> frames, TimePoint) override {
    for (const hal::CanFrame& frame : frames) {
      if (frame.error)
        health.take(frame, counters_);
      else
        ++heard;
    }
    return static_cast<int>(frames.size());
  }
  int receive(std::span<hal::ReceivedCanFrame> frames, TimePoint now) override {
    frames[0] = {kFrame, now};
    return 1;
  }
  hal::BusState state() const override { return health.state(); }
  hal::CanCounters counters() const override { return counters_; }

  hal::BusHealth health;
  int heard = 0;

 private:
  hal::CanCounters counters_;
};

class CanEndTest : public ::testing::Test {
 protected:
  bool passes() {
    std::array<hal::ReceivedCanFrame, 4> in;
    const int before = vcan_->heard;
    sut_.send({&kFrame, 1}, kNow);
    const bool sent = vcan_->heard > before;
    EXPECT_EQ(sut_.receive(in, kNow) == 1, sent);
    return sent;
  }
  PlayedVcan* vcan_ = new PlayedVcan;
  std::vector<std::string> switched_;
  CanEnd sut_{{"socketcan", "vcan0"},
              std::unique_ptr<hal::CanBus>(vcan_),
              [this](const std::string& interface, bool up) -> Result<void> {
                switched_.push_back(interface + (up ? " up" : " down"));
                return {};
              }};
};

TEST_F(CanEndTest, carries_frames_both_ways) { EXPECT_TRUE(passes()); }

TEST_F(CanEndTest, off_the_bus_nobody_hears_anybody) {
  sut_.bus_off(kNow);
  EXPECT_EQ(vcan_->state(), hal::BusState::kOff);
  EXPECT_FALSE(passes());
  ASSERT_TRUE(sut_.bus_up(kNow));
  EXPECT_EQ(vcan_->state(), hal::BusState::kGood);
  EXPECT_EQ(vcan_->counters().restarts, 1u);
  EXPECT_TRUE(passes());
}

TEST_F(CanEndTest, passive_the_bus_still_works) {
  sut_.bus_passive(kNow);
  EXPECT_EQ(vcan_->state(), hal::BusState::kPassive);
  EXPECT_EQ(vcan_->counters().transmit_errors, 136);
  EXPECT_TRUE(passes());
  ASSERT_TRUE(sut_.bus_up(kNow));
  EXPECT_EQ(vcan_->state(), hal::BusState::kGood);
}

TEST_F(CanEndTest, the_interface_goes_down_and_up) {
  ASSERT_TRUE(sut_.bus_down());
  ASSERT_TRUE(sut_.bus_up(kNow));
  EXPECT_EQ(switched_, (std::vector<std::string>{"vcan0 down", "vcan0 up"}));
}

TEST(LocalCanEnd, goes_away_and_comes_back_for_a_daemon_that_waits) {
  const std::string name = "@gannet-can-end-test-" + std::to_string(getpid());
  auto sut = CanEnd::create({"local", name}, kNow);
  ASSERT_TRUE(sut) << sut.error().text;
  auto daemon = hal::LocalBus::connect(name, kNow);
  ASSERT_TRUE(daemon);
  std::array<hal::ReceivedCanFrame, 4> in;
  (*sut)->receive(in, kNow);
  ASSERT_TRUE((*sut)->bus_down());
  (*daemon)->receive(in, kNow);
  EXPECT_EQ((*daemon)->state(), hal::BusState::kDown);
  (*sut)->send({&kFrame, 1}, kNow);
  ASSERT_TRUE((*sut)->bus_up(kNow));
  const TimePoint later = kNow + std::chrono::seconds(2);
  EXPECT_EQ((*daemon)->send({&kFrame, 1}, later), 1);
  EXPECT_EQ((*sut)->receive(in, later), 1);
  EXPECT_EQ(in[0].frame, kFrame);
}

TEST(CanEnd, says_what_it_has_not_got) {
  const auto none = CanEnd::create({"socketcan", "gannet-no-can"}, kNow);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().text.find("gannet-no-can"), std::string::npos);
  const auto switched = switch_link("gannet-no-can", true);
  ASSERT_FALSE(switched);
  EXPECT_NE(switched.error().text.find("gannet-no-can"), std::string::npos);
}

}  // namespace
}  // namespace gannet::world
