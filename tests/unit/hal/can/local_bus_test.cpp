#include "hal/can/local_bus.hpp"

#include <gtest/gtest.h>

#include "hal/can/can_wire.hpp"
#include "tests/support/temporary_folder.hpp"

namespace gannet::hal {
namespace {

using std::chrono::milliseconds;

constexpr TimePoint at_ms(std::int64_t ms) { return TimePoint(milliseconds(ms)); }
CanFrame numbered(std::uint32_t id) {
  return {.id = id, .extended = true, .length = 2, .data = {7, 9}};
}

class LocalBusTest : public testing::Test {
 protected:
  std::unique_ptr<LocalCanHub> listen() { return std::move(LocalCanHub::listen(path_)).value(); }
  std::unique_ptr<LocalBus> connect(std::vector<CanFilter> filters = {}) {
    return std::move(LocalBus::connect(path_, at_ms(0), std::move(filters))).value();
  }
  static int send(CanBus& bus, std::uint32_t id, TimePoint now = at_ms(0)) {
    const CanFrame frame = numbered(id);
    return bus.send({&frame, 1}, now);
  }

  const test::TemporaryFolder folder_;
  const std::string path_ = folder_ / "can0";
  ReceivedCanFrame in_[16];
};

TEST_F(LocalBusTest, FramesGoBothWaysThroughTheHub) {
  auto hub = listen();
  auto node = connect();
  EXPECT_EQ(node->state(), BusState::kGood);
  EXPECT_EQ(send(*node, 1), 1);
  ASSERT_EQ(hub->receive(in_, at_ms(3)), 1);
  EXPECT_EQ(in_[0].frame, numbered(1));
  EXPECT_EQ(in_[0].time, at_ms(3));
  EXPECT_EQ(send(*hub, 2), 1);
  ASSERT_EQ(node->receive(in_, at_ms(4)), 1);
  EXPECT_EQ(in_[0].frame, numbered(2));
}

TEST_F(LocalBusTest, TheHubPassesAFrameToAllOtherNodes) {
  auto hub = listen();
  auto a = connect(), b = connect(), c = connect();
  send(*a, 5);
  EXPECT_EQ(hub->receive(in_, at_ms(0)), 1);
  EXPECT_EQ(hub->nodes(), 3);
  EXPECT_EQ(a->receive(in_, at_ms(0)), 0);
  EXPECT_EQ(b->receive(in_, at_ms(0)), 1);
  EXPECT_EQ(c->receive(in_, at_ms(0)), 1);
}

TEST_F(LocalBusTest, ErrorFramesAreTheBussStateAndOffSendsNothing) {
  auto hub = listen();
  auto node = connect({{.id = 1, .mask = 0x1FFFFFFF, .extended = true}});
  hub->receive(in_, at_ms(0));
  const CanFrame off = {.id = 0x040, .error = true, .length = 8};
  const CanFrame restarted = {.id = 0x100, .error = true, .length = 8};
  hub->send({&off, 1}, at_ms(1));
  EXPECT_EQ(node->receive(in_, at_ms(2)), 0);
  EXPECT_EQ(node->state(), BusState::kOff);
  EXPECT_EQ(send(*node, 1), 0);
  EXPECT_EQ(hub->receive(in_, at_ms(3)), 0);
  hub->send({&restarted, 1}, at_ms(4));
  node->receive(in_, at_ms(5));
  EXPECT_EQ(node->state(), BusState::kGood);
  EXPECT_EQ(send(*node, 1), 1);
  EXPECT_EQ(node->counters().bus_off, 1u);
}

TEST_F(LocalBusTest, APairNeedsNoHub) {
  auto [a, b] = std::move(LocalBus::pair()).value();
  send(*a, 1);
  EXPECT_EQ(b->receive(in_, at_ms(0)), 1);
  a.reset();
  EXPECT_EQ(b->receive(in_, at_ms(0)), 0);
  EXPECT_EQ(b->state(), BusState::kDown);
  EXPECT_EQ(send(*b, 1, at_ms(5000)), 0);
}

TEST_F(LocalBusTest, WithoutAHubItIsDownAndTriesAgainEverLater) {
  auto node = connect();
  EXPECT_EQ(node->state(), BusState::kDown);
  EXPECT_EQ(send(*node, 1, at_ms(1)), 0);
  EXPECT_EQ(node->counters().send_refused, 1u);
  node->receive(in_, at_ms(10));  // second attempt; the third is due 20 ms later
  auto hub = listen();
  EXPECT_EQ(send(*node, 1, at_ms(29)), 0);
  EXPECT_EQ(send(*node, 1, at_ms(30)), 1);
  EXPECT_EQ(node->connections(), 1u);
  EXPECT_EQ(hub->receive(in_, at_ms(31)), 1);
}

TEST_F(LocalBusTest, TheLongestWaitIsASecond) {
  auto node = connect();
  for (int ms = 0; ms < 100000; ms += 10) node->receive(in_, at_ms(ms));
  auto hub = listen();
  node->receive(in_, at_ms(101000));
  EXPECT_EQ(node->state(), BusState::kGood);
}

TEST_F(LocalBusTest, AHubThatGoesIsNoticedAndFoundAgain) {
  auto hub = listen();
  auto node = connect();
  hub->receive(in_, at_ms(0));
  hub.reset();
  EXPECT_EQ(node->receive(in_, at_ms(100)), 0);
  EXPECT_EQ(node->state(), BusState::kDown);
  hub = listen();
  EXPECT_EQ(send(*node, 3, at_ms(110)), 1);
  EXPECT_EQ(node->state(), BusState::kGood);
  EXPECT_EQ(hub->receive(in_, at_ms(111)), 1);
}

TEST_F(LocalBusTest, ANodeThatGoesLeavesTheHubRunning) {
  auto hub = listen();
  auto a = connect(), b = connect();
  hub->receive(in_, at_ms(0));
  a.reset();
  send(*hub, 1);
  EXPECT_EQ(hub->receive(in_, at_ms(0)), 0);
  EXPECT_EQ(hub->nodes(), 1);
  EXPECT_EQ(b->receive(in_, at_ms(0)), 1);
}

TEST_F(LocalBusTest, AFullSocketRefusesAndCountsInsteadOfBlocking) {
  auto hub = listen();
  auto node = connect();
  hub->receive(in_, at_ms(0));
  const std::vector<CanFrame> many(20000, numbered(1));
  const int taken = node->send(many, at_ms(0));
  EXPECT_GT(taken, 50);  // some cycles' worth of frames fit
  EXPECT_LT(taken, 20000);
  EXPECT_EQ(node->counters().sent, static_cast<std::uint64_t>(taken));
  EXPECT_EQ(node->counters().send_refused, many.size() - static_cast<std::size_t>(taken));
  EXPECT_EQ(node->state(), BusState::kGood);
}

TEST_F(LocalBusTest, ForeignShortAndLongPacketsAreCountedAsMalformed) {
  auto hub = listen();
  auto socket =
      std::move(linux_os::UnixSocket::connect(path_, linux_os::SocketKind::kSeqPacket)).value();
  std::byte junk[40] = {};
  socket.send(std::span(junk).first(1));
  socket.send(std::span(junk).first(15));
  socket.send(junk);
  CanWire remote = to_wire(numbered(1));
  remote[3] |= 0x40;  // CAN_RTR_FLAG on a little-endian machine
  socket.send(std::as_bytes(std::span(remote)));
  const CanWire good = to_wire(numbered(8));
  socket.send(std::as_bytes(std::span(good)));
  ASSERT_EQ(hub->receive(in_, at_ms(0)), 1);
  EXPECT_EQ(in_[0].frame.id, 8u);
  EXPECT_EQ(hub->counters().malformed, 4u);
}

TEST_F(LocalBusTest, OnlyWantedFramesAreReceived) {
  auto hub = listen();
  auto node = connect({{.id = 0x100, .mask = 0xF00, .extended = true}});
  hub->receive(in_, at_ms(0));
  for (std::uint32_t id : {0x123u, 0x223u, 0x1FFu}) send(*hub, id);
  ASSERT_EQ(node->receive(in_, at_ms(0)), 2);
  EXPECT_EQ(in_[0].frame.id, 0x123u);
  EXPECT_EQ(in_[1].frame.id, 0x1FFu);
}

TEST_F(LocalBusTest, ASecondHubOnTheSamePathIsRefused) {
  auto hub = listen();
  const auto second = LocalCanHub::listen(path_);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().text.find(path_), std::string::npos);
}

TEST_F(LocalBusTest, ANameThatIsNoSocketNameIsRefused) {
  EXPECT_FALSE(LocalBus::connect("", at_ms(0)));
  EXPECT_FALSE(LocalBus::connect(std::string(200, 'x'), at_ms(0)));
}

}  // namespace
}  // namespace gannet::hal
