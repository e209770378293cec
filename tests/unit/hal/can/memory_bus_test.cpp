#include "hal/can/memory_bus.hpp"

#include <gtest/gtest.h>

namespace gannet::hal {
namespace {

CanFrame numbered(std::uint32_t id) { return {.id = id}; }

TEST(MemoryWire, WhatOnePortSendsAllOthersReceiveInOrder) {
  MemoryWire wire(3);
  const CanFrame frames[] = {numbered(1), numbered(2)};
  EXPECT_EQ(wire.port(0).send(frames, time_from_ns(5)), 2);
  ReceivedCanFrame in[4];
  EXPECT_EQ(wire.port(0).receive(in, time_from_ns(6)), 0);
  for (int port : {1, 2}) {
    ASSERT_EQ(wire.port(port).receive(in, time_from_ns(6)), 2);
    EXPECT_EQ(in[0].frame.id, 1u);
    EXPECT_EQ(in[1].frame.id, 2u);
    EXPECT_EQ(in[1].time, time_from_ns(5));
  }
}

TEST(MemoryWire, AFullPortLosesTheNewestAndCountsIt) {
  MemoryWire wire(2, 3);
  for (std::uint32_t id = 0; id < 5; ++id) {
    const CanFrame frame = numbered(id);
    wire.port(0).send({&frame, 1}, {});
  }
  ReceivedCanFrame in[8];
  ASSERT_EQ(wire.port(1).receive(in, {}), 3);
  EXPECT_EQ(in[2].frame.id, 2u);
  EXPECT_EQ(wire.port(1).counters().receive_dropped, 2u);
  EXPECT_EQ(wire.port(1).counters().received, 3u);
}

TEST(MemoryWire, ACutWireIsDownAndRefuses) {
  MemoryWire wire(2);
  wire.cut(true);
  const CanFrame frame = numbered(1);
  EXPECT_EQ(wire.port(0).state(), BusState::kDown);
  EXPECT_EQ(wire.port(0).send({&frame, 1}, {}), 0);
  EXPECT_EQ(wire.port(0).counters().send_refused, 1u);
  wire.cut(false);
  EXPECT_EQ(wire.port(0).send({&frame, 1}, {}), 1);
  EXPECT_EQ(wire.port(0).state(), BusState::kGood);
}

TEST(MemoryWire, ALonelyBusTakesFramesAndHearsNothing) {
  const auto sut = make_lonely_bus();
  const CanFrame frame = numbered(1);
  ReceivedCanFrame in[1];
  EXPECT_EQ(sut->send({&frame, 1}, {}), 1);
  EXPECT_EQ(sut->receive(in, {}), 0);
  EXPECT_EQ(sut->counters().sent, 1u);
}

}  // namespace
}  // namespace gannet::hal
