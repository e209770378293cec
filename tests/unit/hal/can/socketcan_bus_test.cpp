#include "hal/can/socketcan_bus.hpp"

#include <gtest/gtest.h>

#include "tests/support/heap_calls.hpp"
#include "tests/unit/hal/can/scripted_can.hpp"

namespace gannet::hal {
namespace {

using test::kSecond;
using test::ScriptedCan;

constexpr std::int64_t kMs = 1'000'000;
constexpr CanFrame kData = {.id = 0x123, .length = 2, .data = {1, 2}};

std::unique_ptr<SocketCanBus> opened(ScriptedCan& kernel, std::vector<CanFilter> wanted = {},
                                     int most_waiting = 0) {
  auto bus = SocketCanBus::open("can0", wanted, most_waiting, kernel.now(), kernel);
  EXPECT_TRUE(bus) << (bus ? "" : bus.error().text);
  return bus ? std::move(*bus) : nullptr;
}

std::string refusal(ScriptedCan& kernel, const std::string& name = "can0",
                    std::size_t filters = 0) {
  const auto bus =
      SocketCanBus::open(name, std::vector<CanFilter>(filters), 0, kernel.now(), kernel);
  EXPECT_TRUE(kernel.open_fds.empty()) << "a socket was left open";
  return bus ? "" : bus.error().text;
}

int send_one(SocketCanBus& bus, const ScriptedCan& kernel) {
  return bus.send({&kData, 1}, kernel.now());
}

std::vector<ReceivedCanFrame> receive_all(SocketCanBus& bus, const ScriptedCan& kernel) {
  std::vector<ReceivedCanFrame> frames(64);
  frames.resize(static_cast<std::size_t>(bus.receive(frames, kernel.now())));
  return frames;
}

template <class T>
std::vector<T> option(const ScriptedCan& kernel, int level, int name) {
  const auto& bytes = kernel.options.at({level, name});
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

// ---- opening ------------------------------------------------------------------------------------

TEST(SocketCanBus, AsksTheKernelForExactlyTheWantedFramesBeforeItBinds) {
  ScriptedCan kernel;
  const auto bus = opened(kernel, {{.id = 0x581, .mask = 0x7FF},
                                   {.id = 0x1234567, .mask = 0x1FFFFFFF, .extended = true}});
  EXPECT_EQ(kernel.calls.back(), "bind");
  const auto filters = option<can_filter>(kernel, SOL_CAN_RAW, CAN_RAW_FILTER);
  ASSERT_EQ(filters.size(), 2u);
  const auto passes = [&](std::uint32_t id) {  // as the kernel decides
    for (const can_filter& f : filters) {
      if ((id & f.can_mask) == (f.can_id & f.can_mask)) return true;
    }
    return false;
  };
  EXPECT_TRUE(passes(0x581));
  EXPECT_FALSE(passes(0x582));
  EXPECT_FALSE(passes(0x581 | CAN_EFF_FLAG));
  EXPECT_FALSE(passes(0x581 | CAN_RTR_FLAG));
  EXPECT_TRUE(passes(0x1234567 | CAN_EFF_FLAG));
  EXPECT_FALSE(passes(0x1234566 | CAN_EFF_FLAG));
  EXPECT_FALSE(passes(0x1234567 | CAN_EFF_FLAG | CAN_RTR_FLAG));
  EXPECT_EQ(option<can_err_mask_t>(kernel, SOL_CAN_RAW, CAN_RAW_ERR_FILTER).at(0), CAN_ERR_MASK);
  EXPECT_EQ(option<int>(kernel, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS).at(0), 0);
  EXPECT_EQ(option<int>(kernel, SOL_SOCKET, SO_TIMESTAMPNS).at(0), 1);
  EXPECT_EQ(option<int>(kernel, SOL_SOCKET, SO_RXQ_OVFL).at(0), 1);
}

TEST(SocketCanBus, WithoutFiltersAllDataFramesPass) {
  ScriptedCan kernel;
  const auto bus = opened(kernel);
  const auto filters = option<can_filter>(kernel, SOL_CAN_RAW, CAN_RAW_FILTER);
  ASSERT_EQ(filters.size(), 1u);
  EXPECT_EQ(filters[0].can_id, 0u);
  EXPECT_EQ(filters[0].can_mask, CAN_RTR_FLAG);
}

TEST(SocketCanBus, AMissingInterfaceIsRefusedWithWhatToDo) {
  ScriptedCan kernel;
  kernel.index = -1;
  const std::string text = refusal(kernel);
  EXPECT_NE(text.find("'can0'"), std::string::npos) << text;
  EXPECT_NE(text.find("systemctl start gannet-can@can0"), std::string::npos) << text;
}

TEST(SocketCanBus, OtherStartErrorsNameTheirReason) {
  ScriptedCan kernel;
  EXPECT_NE(refusal(kernel, "").find("1 to 15"), std::string::npos);
  EXPECT_NE(refusal(kernel, "sixteen_letters_").find("1 to 15"), std::string::npos);
  EXPECT_NE(refusal(kernel, "can0", CAN_RAW_FILTER_MAX + 1).find("filters"), std::string::npos);
  kernel.failing_option = SO_RXQ_OVFL;
  EXPECT_NE(refusal(kernel).find("setsockopt: "), std::string::npos);
  kernel.failing_option = -1;
  kernel.is_can = false;
  EXPECT_NE(refusal(kernel).find("is no CAN interface"), std::string::npos);
  kernel.has_can = false;
  EXPECT_NE(refusal(kernel).find("modprobe can_raw"), std::string::npos);
}

TEST(SocketCanBus, TheRealKernelRefusesAnInterfaceThatIsNotThere) {
  const auto bus = SocketCanBus::open("gannet_none", {}, 0, {});
  ASSERT_FALSE(bus);
  EXPECT_NE(bus.error().text.find("gannet_none"), std::string::npos) << bus.error().text;
}

TEST(SocketCanBus, AnInterfaceThatIsDownIsAcceptedAndWaitedFor) {
  ScriptedCan kernel;
  kernel.flags = 0;
  const auto bus = opened(kernel);
  EXPECT_EQ(bus->state(), BusState::kDown);
  EXPECT_EQ(send_one(*bus, kernel), 0);
  EXPECT_EQ(bus->counters().send_refused, 1u);
  kernel.come_up();
  kernel.advance(20 * kMs);
  EXPECT_EQ(send_one(*bus, kernel), 1);
  EXPECT_EQ(bus->state(), BusState::kGood);
  receive_all(*bus, kernel);
  EXPECT_EQ(bus->state(), BusState::kGood) << "the error of binding is not taken for a loss";
  EXPECT_EQ(bus->counters().links_lost, 0u);
}

// ---- frames -------------------------------------------------------------------------------------

TEST(SocketCanBus, SendsInBatches) {
  ScriptedCan kernel;
  const auto bus = opened(kernel);
  std::vector<CanFrame> frames(70, kData);
  for (std::size_t i = 0; i < frames.size(); ++i) frames[i].id = static_cast<std::uint32_t>(i);
  EXPECT_EQ(bus->send(frames, kernel.now()), 70);
  EXPECT_EQ(kernel.send_calls, 3);
  ASSERT_EQ(kernel.sent.size(), 70u);
  for (std::size_t i = 0; i < 70; ++i) EXPECT_EQ(kernel.sent[i].can_id, i);
  EXPECT_EQ(kernel.sent[0].len, 2);
  EXPECT_EQ(bus->counters().sent, 70u);
}

TEST(SocketCanBus, AFullQueueRefusesTheRestAndIsNoLoss) {
  ScriptedCan kernel;
  const auto bus = opened(kernel);
  kernel.room = 5;
  const std::vector<CanFrame> frames(8, kData);
  EXPECT_EQ(bus->send(frames, kernel.now()), 5);
  EXPECT_EQ(bus->send(frames, kernel.now()), 0);
  EXPECT_EQ(bus->counters().send_refused, 11u);
  EXPECT_EQ(bus->counters().send_no_room, 11u);
  EXPECT_EQ(bus->state(), BusState::kGood);
  kernel.room = 100;
  EXPECT_EQ(bus->send(frames, kernel.now()), 8) << "at once, there is nothing to wait for";
}

TEST(SocketCanBus, NoMoreFramesWaitThanTheCallerAllows) {
  ScriptedCan kernel;
  const auto bus = opened(kernel, {}, 16);
  kernel.hold_up();  // the interface's queue is long, and nothing leaves it
  const std::vector<CanFrame> cycle(3, kData);
  for (int i = 0; i < 100; ++i) bus->send(cycle, kernel.now());
  EXPECT_EQ(kernel.sent.size(), 16u);
  EXPECT_EQ(bus->counters().send_no_room, 284u);
  EXPECT_EQ(bus->counters().send_refused, 284u);
  EXPECT_EQ(bus->state(), BusState::kGood);
  kernel.flow();
  EXPECT_EQ(bus->send(cycle, kernel.now()), 3);
}

TEST(SocketCanBus, TheKernelGrantsRoomForSixFrames) {
  ScriptedCan kernel;
  const auto bus = opened(kernel, {}, 1);
  kernel.hold_up();
  EXPECT_EQ(bus->send(std::vector<CanFrame>(40, kData), kernel.now()), 6);
}

TEST(SocketCanBus, ALongQueueIsTheKernelsBusinessWhereNobodyAsks) {
  ScriptedCan kernel;
  const auto bus = opened(kernel);
  EXPECT_EQ(kernel.options.count({SOL_SOCKET, SO_SNDBUF}), 0u);
}

TEST(SocketCanBus, AnInterfaceMadeAnewHasTheSameLimit) {
  ScriptedCan kernel;
  const auto bus = opened(kernel, {}, 16);
  kernel.take_away();
  bus->send({&kData, 1}, kernel.now());
  kernel.bring_back(4);
  kernel.options.clear();
  kernel.advance(kSecond);
  EXPECT_EQ(send_one(*bus, kernel), 1);
  kernel.hold_up();
  EXPECT_EQ(bus->send(std::vector<CanFrame>(40, kData), kernel.now()), 16);
}

TEST(SocketCanBus, WhatIsRefusedWhileTheBusIsAwayIsNotForWantOfRoom) {
  ScriptedCan kernel;
  const auto bus = opened(kernel, {}, 16);
  kernel.go_down();
  EXPECT_EQ(send_one(*bus, kernel), 0);
  EXPECT_EQ(bus->counters().send_refused, 1u);
  EXPECT_EQ(bus->counters().send_no_room, 0u);
}

TEST(SocketCanBus, ReceivesInBatchesAndLeavesWhatHasNoRoom) {
  ScriptedCan kernel;
  const auto bus = opened(kernel);
  for (std::uint32_t i = 0; i < 50; ++i) kernel.arrive(CanFrame{.id = i});
  std::vector<ReceivedCanFrame> frames(40);
  ASSERT_EQ(bus->receive(frames, kernel.now()), 40);
  EXPECT_EQ(kernel.receive_calls, 2);
  EXPECT_EQ(kernel.waiting(), 10);
  for (std::uint32_t i = 0; i < 40; ++i) EXPECT_EQ(frames[i].frame.id, i);
  EXPECT_EQ(bus->receive(frames, kernel.now()), 10);
  EXPECT_EQ(frames[9].frame.id, 49u);
  EXPECT_EQ(bus->counters().received, 50u);
}

TEST(SocketCanBus, AFloodOfErrorFramesDoesNotHoldTheCall) {
  ScriptedCan kernel;
  const auto bus = opened(kernel);
  for (int i = 0; i < 5000; ++i) kernel.arrive_error(CAN_ERR_BUSERROR);
  EXPECT_TRUE(receive_all(*bus, kernel).empty());
  EXPECT_GT(kernel.waiting(), 4500);
  EXPECT_LE(kernel.receive_calls, 8);
}

TEST(SocketCanBus, CountsWhatIsNoClassicFrame) {
  ScriptedCan kernel;
  const auto bus = opened(kernel);
  kernel.arrive(ScriptedCan::Incoming{.size = 5});
  kernel.arrive(ScriptedCan::Incoming{.size = CANFD_MTU});
  kernel.arrive(ScriptedCan::Incoming{.is_cut = true});
  ScriptedCan::Incoming remote{.wire = to_wire(kData)};
  remote.wire[3] |= CAN_RTR_FLAG >> 24;
  kernel.arrive(remote);
  kernel.arrive(kData);
  const auto frames = receive_all(*bus, kernel);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].frame, kData);
  EXPECT_EQ(bus->counters().malformed, 4u);
}

TEST(SocketCanBus, CountsWhatTheSocketDropped) {
  ScriptedCan kernel;
  const auto bus = opened(kernel);
  const auto drops = [&](std::uint32_t told) {
    kernel.arrive(ScriptedCan::Incoming{.wire = to_wire(kData), .drops = told});
    receive_all(*bus, kernel);
    return bus->counters().receive_dropped;
  };
  EXPECT_EQ(drops(0), 0u);
  EXPECT_EQ(drops(7), 7u);
  EXPECT_EQ(drops(7), 7u) << "the count is since the socket was made";
  EXPECT_EQ(drops(0xFFFFFFFF), 0xFFFFFFFFu);
  EXPECT_EQ(drops(2), 0xFFFFFFFFull + 3) << "and it wraps round";
}

// ---- times --------------------------------------------------------------------------------------

class Stamps : public testing::Test {
 protected:
  Stamps() : bus_(opened(kernel_)) { step(); }
  void step(std::int64_t ns = 5 * kMs) {
    kernel_.advance(ns);
    receive_all(*bus_, kernel_);
  }
  // The age of the next frame.
  std::int64_t age() {
    const auto frames = receive_all(*bus_, kernel_);
    EXPECT_EQ(frames.size(), 1u);
    return frames.empty() ? -1 : (kernel_.now() - frames[0].time).count();
  }

  ScriptedCan kernel_;
  std::unique_ptr<SocketCanBus> bus_;
};

TEST_F(Stamps, BecomeMonotonicTimes) {
  kernel_.arrive(kData);
  kernel_.advance(3 * kMs);
  EXPECT_EQ(age(), 3 * kMs);
  EXPECT_EQ(bus_->counters().clock_steps, 0u);
}

TEST_F(Stamps, AFrameWithoutOneHasTheTimeOfReceipt) {
  kernel_.arrive(ScriptedCan::Incoming{.wire = to_wire(kData)});
  kernel_.advance(3 * kMs);
  EXPECT_EQ(age(), 0);
  EXPECT_EQ(bus_->counters().clock_steps, 0u);
}

TEST_F(Stamps, AWallClockThatWasSetBackMakesThemFutureOnes) {
  kernel_.arrive(kData);
  kernel_.advance(3 * kMs);
  kernel_.realtime_ns -= 10 * kSecond;
  EXPECT_EQ(age(), 0);
  EXPECT_EQ(bus_->counters().clock_steps, 1u);
  kernel_.arrive(kData);
  kernel_.advance(2 * kMs);
  EXPECT_EQ(age(), 2 * kMs) << "the next batch has a new offset";
  EXPECT_EQ(bus_->counters().clock_steps, 1u);
}

TEST_F(Stamps, AWallClockThatWasSetForwardMakesThemOlderThanTheyCanBe) {
  kernel_.arrive(kData);
  kernel_.advance(1 * kMs);
  kernel_.realtime_ns += 20 * kMs;  // the socket was empty a millisecond ago
  EXPECT_EQ(age(), 0);
  EXPECT_EQ(bus_->counters().clock_steps, 1u);
}

TEST_F(Stamps, AFrameThatWaitedLongIsOldAndBelieved) {
  kernel_.arrive(kData);
  kernel_.advance(2 * kSecond);
  EXPECT_EQ(age(), 2 * kSecond);
  EXPECT_EQ(bus_->counters().clock_steps, 0u);
}

TEST_F(Stamps, OfAFullBatchMayBeAsOldAsTheLastEmptySocket) {
  for (int i = 0; i < 100; ++i) kernel_.arrive(kData);
  kernel_.advance(3 * kMs);
  EXPECT_EQ(receive_all(*bus_, kernel_).size(), 64u);
  kernel_.advance(5 * kMs);
  const auto rest = receive_all(*bus_, kernel_);
  ASSERT_EQ(rest.size(), 36u);
  EXPECT_EQ((kernel_.now() - rest[35].time).count(), 8 * kMs);
  EXPECT_EQ(bus_->counters().clock_steps, 0u);
}

// ---- the bus's state ----------------------------------------------------------------------------

TEST(SocketCanBus, ErrorFramesBecomeStateAndAreNotHandedOut) {
  ScriptedCan kernel;
  const auto bus = opened(kernel);
  kernel.arrive(kData);
  kernel.arrive_error(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_TX_PASSIVE});
  kernel.arrive(kData);
  EXPECT_EQ(receive_all(*bus, kernel).size(), 2u);
  EXPECT_EQ(bus->state(), BusState::kPassive);
  EXPECT_EQ(send_one(*bus, kernel), 1) << "a passive controller still sends";
  EXPECT_EQ(bus->counters().error_frames, 1u);
  EXPECT_EQ(bus->counters().received, 2u);
}

TEST(SocketCanBus, WhileOffNothingIsQueuedForLater) {
  ScriptedCan kernel;
  const auto bus = opened(kernel);
  kernel.arrive_error(CAN_ERR_BUSOFF);
  receive_all(*bus, kernel);
  EXPECT_EQ(bus->state(), BusState::kOff);
  EXPECT_EQ(send_one(*bus, kernel), 0);
  EXPECT_TRUE(kernel.sent.empty());
  kernel.advance(kSecond);  // a carrier that never went says nothing
  receive_all(*bus, kernel);
  EXPECT_EQ(bus->state(), BusState::kOff);
  kernel.arrive_error(CAN_ERR_RESTARTED);
  receive_all(*bus, kernel);
  EXPECT_EQ(bus->state(), BusState::kGood);
  EXPECT_EQ(send_one(*bus, kernel), 1);
  EXPECT_EQ(bus->counters().bus_off, 1u);
  EXPECT_EQ(bus->counters().restarts, 1u);
}

TEST(SocketCanBus, ARestartWhoseErrorFrameWasLostIsSeenByTheCarrier) {
  ScriptedCan kernel;
  const auto bus = opened(kernel);
  kernel.arrive_error(CAN_ERR_BUSOFF);
  receive_all(*bus, kernel);
  kernel.flags = IFF_UP;
  kernel.advance(20 * kMs);
  receive_all(*bus, kernel);
  EXPECT_EQ(bus->state(), BusState::kOff);
  kernel.flags = IFF_UP | IFF_RUNNING;
  kernel.advance(20 * kMs);
  receive_all(*bus, kernel);
  EXPECT_EQ(bus->state(), BusState::kGood);
}

TEST(SocketCanBus, AControllerThatIsOffAtTheStartIsSeenByItsCarrier) {
  ScriptedCan kernel;
  kernel.flags = IFF_UP;
  const auto bus = opened(kernel);
  EXPECT_EQ(bus->state(), BusState::kOff);
  kernel.come_up();
  kernel.advance(20 * kMs);
  receive_all(*bus, kernel);
  EXPECT_EQ(bus->state(), BusState::kGood);
}

// ---- the interface comes and goes ---------------------------------------------------------------

TEST(SocketCanBus, GoesDownAndUpWithItsInterface) {
  ScriptedCan kernel;
  const auto bus = opened(kernel);
  const int fd = bus->fd();
  kernel.arrive_error(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_TX_PASSIVE});
  receive_all(*bus, kernel);
  kernel.go_down();
  receive_all(*bus, kernel);
  EXPECT_EQ(bus->state(), BusState::kDown);
  EXPECT_EQ(send_one(*bus, kernel), 0);
  EXPECT_EQ(kernel.send_calls, 0) << "refused without asking";
  kernel.come_up();
  EXPECT_EQ(bus->state(), BusState::kDown);
  kernel.advance(10 * kMs);
  kernel.arrive(kData);
  EXPECT_EQ(receive_all(*bus, kernel).size(), 1u);
  EXPECT_EQ(bus->state(), BusState::kGood) << "a controller starts anew";
  EXPECT_EQ(bus->fd(), fd) << "the socket is still bound";
  EXPECT_EQ(bus->counters().links_lost, 1u);
}

TEST(SocketCanBus, SendingNoticesALossToo) {
  ScriptedCan kernel;
  const auto bus = opened(kernel);
  kernel.go_down();
  EXPECT_EQ(send_one(*bus, kernel), 0);
  EXPECT_EQ(bus->state(), BusState::kDown);
}

TEST(SocketCanBus, ALossOfAMomentIsSeenForOneCycleAtLeast) {
  ScriptedCan kernel;
  const auto bus = opened(kernel);
  kernel.go_down();
  kernel.come_up();
  receive_all(*bus, kernel);
  EXPECT_EQ(bus->state(), BusState::kDown);
  EXPECT_EQ(send_one(*bus, kernel), 0);
  kernel.advance(10 * kMs);
  receive_all(*bus, kernel);
  EXPECT_EQ(bus->state(), BusState::kGood);
}

TEST(SocketCanBus, FindsAnInterfaceThatWasMadeAnew) {
  ScriptedCan kernel;
  const auto bus = opened(kernel, {{.id = 0x123, .mask = 0x7FF}});
  kernel.arrive(ScriptedCan::Incoming{.wire = to_wire(kData), .drops = 9});
  receive_all(*bus, kernel);
  kernel.take_away();
  receive_all(*bus, kernel);
  EXPECT_EQ(bus->state(), BusState::kDown);
  kernel.advance(kSecond);
  receive_all(*bus, kernel);
  EXPECT_EQ(bus->state(), BusState::kDown);
  kernel.options.clear();
  kernel.bring_back(8);
  kernel.advance(kSecond);
  EXPECT_EQ(send_one(*bus, kernel), 1);
  EXPECT_EQ(bus->state(), BusState::kGood);
  EXPECT_EQ(kernel.open_fds, std::set<int>{bus->fd()}) << "the old socket is closed";
  EXPECT_EQ(option<can_filter>(kernel, SOL_CAN_RAW, CAN_RAW_FILTER).size(), 1u);
  kernel.arrive(ScriptedCan::Incoming{.wire = to_wire(kData), .drops = 4});
  receive_all(*bus, kernel);
  EXPECT_EQ(bus->counters().receive_dropped, 13u) << "a new socket counts from zero";
}

TEST(SocketCanBus, IsNotFooledByAnotherInterfaceOfTheSameName) {
  ScriptedCan kernel;
  const auto bus = opened(kernel);
  kernel.go_down();
  receive_all(*bus, kernel);
  kernel.take_away();
  kernel.bring_back(9);  // between two looks: only the index tells
  kernel.advance(20 * kMs);
  EXPECT_EQ(send_one(*bus, kernel), 1);
  EXPECT_EQ(kernel.open_fds.size(), 1u);
}

TEST(SocketCanBus, LooksEverLaterForAnInterfaceThatIsAway) {
  ScriptedCan kernel;
  const auto bus = opened(kernel);
  kernel.take_away();
  receive_all(*bus, kernel);
  const int before = kernel.index_calls;
  for (int cycle = 0; cycle < 2000; ++cycle) {  // ten seconds
    kernel.advance(5 * kMs);
    receive_all(*bus, kernel);
    send_one(*bus, kernel);
  }
  EXPECT_GE(kernel.index_calls - before, 20);
  EXPECT_LE(kernel.index_calls - before, 30);
  kernel.bring_back(4);
  kernel.advance(500 * kMs);
  receive_all(*bus, kernel);
  EXPECT_EQ(bus->state(), BusState::kGood);
}

TEST(SocketCanBus, NoFaultTakesMemory) {
  if (!test::kCountsHeap) GTEST_SKIP() << "the sanitizer has its own heap";
  ScriptedCan kernel;
  const auto bus = opened(kernel);
  kernel.is_noting = false;
  for (int i = 0; i < 200; ++i) kernel.arrive(kData);
  for (int i = 0; i < 200; ++i) kernel.arrive_error(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_TX_WARNING});
  const std::vector<CanFrame> frames(40, kData);
  std::array<ReceivedCanFrame, 64> in;
  std::uint64_t calls = 0;
  for (int cycle = 0; cycle < 300; ++cycle) {
    kernel.advance(5 * kMs);
    if (cycle == 50) kernel.go_down();
    if (cycle == 100) kernel.come_up();
    if (cycle == 150) kernel.take_away();
    if (cycle == 200) kernel.bring_back(7);
    const std::uint64_t before = test::heap_calls;
    bus->receive(in, kernel.now());
    bus->send(frames, kernel.now());
    // The scripted queue gives its own memory back while it is read.
    if (kernel.waiting() == 0) calls += test::heap_calls - before;
  }
  EXPECT_EQ(calls, 0u);
  EXPECT_EQ(bus->state(), BusState::kGood);
  EXPECT_EQ(bus->counters().links_lost, 2u);
}

}  // namespace
}  // namespace gannet::hal
