// SocketCanBus on the real kernel: where a virtual interface can be made (root, module vcan), else
// skipped. What the scripted kernel only claims is seen here.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <thread>

#include "hal/can/socketcan_bus.hpp"
#include "platform/linux/clock.hpp"

namespace gannet::hal {
namespace {

using linux_os::monotonic_now;
using std::chrono::milliseconds;

const CanFrame kData = {.id = 0x123, .length = 2, .data = {1, 2}};

class VcanTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!ip("link add " + name_ + " type vcan")) GTEST_SKIP() << "no vcan can be made here";
    ASSERT_TRUE(ip("link set " + name_ + " up"));
  }
  void TearDown() override { ip("link del " + name_); }

  static bool ip(const std::string& words) {
    return std::system(("ip " + words + " 2>/dev/null").c_str()) == 0;
  }
  std::unique_ptr<SocketCanBus> open(std::vector<CanFilter> wanted = {}) {
    auto bus = SocketCanBus::open(name_, wanted, 32, monotonic_now());
    EXPECT_TRUE(bus) << (bus ? "" : bus.error().text);
    return bus ? std::move(*bus) : nullptr;
  }
  static int send(CanBus& bus, const CanFrame& frame) {
    return bus.send({&frame, 1}, monotonic_now());
  }
  static std::vector<ReceivedCanFrame> receive(CanBus& bus) {
    std::vector<ReceivedCanFrame> frames(64);
    frames.resize(static_cast<std::size_t>(bus.receive(frames, monotonic_now())));
    return frames;
  }
  // Cycles of 5 ms until the state is there, for a second at most.
  static bool becomes(CanBus& bus, BusState state) {
    for (int cycle = 0; cycle < 200; ++cycle) {
      receive(bus);
      if (bus.state() == state) return true;
      std::this_thread::sleep_for(milliseconds(5));
    }
    return false;
  }

  const std::string name_ = "gn" + std::to_string(getpid());
};

TEST_F(VcanTest, FramesOfTheWantedIdsArriveWithTheirTime) {
  const auto a = open();
  const auto b = open({{.id = 0x123, .mask = 0x7FF}});
  // The first socket of a machine that asks for stamps has them some moments later; until then they
  // are the times of reading.
  std::this_thread::sleep_for(milliseconds(50));
  const TimePoint before = monotonic_now();
  EXPECT_EQ(send(*a, kData), 1);
  EXPECT_EQ(send(*a, {.id = 0x124}), 1);
  EXPECT_EQ(send(*a, {.id = 0x123, .extended = true}), 1);
  const TimePoint after = monotonic_now();
  std::this_thread::sleep_for(milliseconds(20));
  const auto frames = receive(*b);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].frame, kData);
  EXPECT_GE(frames[0].time, before - milliseconds(1));
  EXPECT_LE(frames[0].time, after + milliseconds(1));
  EXPECT_EQ(b->counters().clock_steps, 0u);
  EXPECT_TRUE(receive(*a).empty()) << "own frames do not come back";
}

TEST_F(VcanTest, ErrorFramesPassTheFilters) {
  const auto a = open();
  const auto b = open({{.id = 0x123, .mask = 0x7FF}});
  send(*a, {.id = 0x040, .error = true, .length = 8});
  EXPECT_TRUE(receive(*b).empty());
  EXPECT_EQ(b->state(), BusState::kOff);
  send(*a, {.id = 0x100, .error = true, .length = 8});
  EXPECT_TRUE(becomes(*b, BusState::kGood));
}

TEST_F(VcanTest, WhatTheSocketDropsIsCounted) {
  const auto a = open();
  const auto b = open();
  const std::vector<CanFrame> frames(2000, kData);
  const int sent = a->send(frames, monotonic_now());
  int received = 0;
  for (int n = 1; n != 0; received += n) n = static_cast<int>(receive(*b).size());
  send(*a, kData);  // the count comes with the next frame
  received += static_cast<int>(receive(*b).size());
  EXPECT_LT(received, sent + 1);
  EXPECT_EQ(b->counters().receive_dropped, static_cast<std::uint64_t>(sent + 1 - received));
}

TEST_F(VcanTest, AnInterfaceThatGoesDownAndUpIsFollowed) {
  const auto a = open();
  const auto b = open();
  ASSERT_TRUE(ip("link set " + name_ + " down"));
  EXPECT_TRUE(becomes(*a, BusState::kDown));
  EXPECT_EQ(send(*b, kData), 0);  // this one notices by sending
  EXPECT_EQ(b->state(), BusState::kDown);
  ASSERT_TRUE(ip("link set " + name_ + " up"));
  EXPECT_TRUE(becomes(*a, BusState::kGood));
  EXPECT_TRUE(becomes(*b, BusState::kGood));
  EXPECT_EQ(send(*a, kData), 1);
  EXPECT_EQ(receive(*b).size(), 1u);
  EXPECT_EQ(a->counters().links_lost, 1u);
}

TEST_F(VcanTest, AnInterfaceThatIsMadeAnewIsFound) {
  const auto a = open();
  const auto b = open({{.id = 0x123, .mask = 0x7FF}});
  ASSERT_TRUE(ip("link del " + name_));
  EXPECT_TRUE(becomes(*a, BusState::kDown));
  EXPECT_EQ(send(*b, kData), 0);
  EXPECT_EQ(b->state(), BusState::kDown);
  ASSERT_TRUE(ip("link add " + name_ + " type vcan") && ip("link set " + name_ + " up"));
  EXPECT_TRUE(becomes(*a, BusState::kGood));
  EXPECT_TRUE(becomes(*b, BusState::kGood));
  EXPECT_EQ(send(*a, {.id = 0x124}), 1);
  EXPECT_EQ(send(*a, kData), 1);
  EXPECT_EQ(receive(*b).size(), 1u) << "the filters are there again";
}

TEST_F(VcanTest, AnInterfaceThatIsDownAtTheStartIsWaitedFor) {
  ASSERT_TRUE(ip("link set " + name_ + " down"));
  const auto a = open();
  EXPECT_EQ(a->state(), BusState::kDown);
  ASSERT_TRUE(ip("link set " + name_ + " up"));
  EXPECT_TRUE(becomes(*a, BusState::kGood));
  EXPECT_EQ(send(*a, kData), 1);
  EXPECT_EQ(a->counters().links_lost, 0u);
}

}  // namespace
}  // namespace gannet::hal
