#include "hal/can/can_wire.hpp"

#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/error.h>

#include <cstring>

namespace gannet::hal {
namespace {

static_assert(sizeof(can_frame) == kCanWireBytes);

CanWire kernel_bytes(std::uint32_t id, std::uint8_t length, std::uint8_t first) {
  can_frame frame = {};
  frame.can_id = id;
  frame.len = length;
  frame.data[0] = first;
  CanWire wire;
  std::memcpy(wire.data(), &frame, sizeof frame);
  return wire;
}

TEST(CanWire, AreTheBytesOfTheKernelsStruct) {
  const CanFrame extended = {.id = 0x1234567, .extended = true, .length = 1, .data = {0xA5}};
  const CanFrame standard = {.id = 0x7FF, .length = 8, .data = {0xA5}};
  const CanFrame error = {.id = CAN_ERR_BUSOFF, .error = true, .length = 8, .data = {0xA5}};
  EXPECT_EQ(to_wire(extended), kernel_bytes(0x1234567 | CAN_EFF_FLAG, 1, 0xA5));
  EXPECT_EQ(to_wire(standard), kernel_bytes(0x7FF, 8, 0xA5));
  EXPECT_EQ(to_wire(error), kernel_bytes(CAN_ERR_BUSOFF | CAN_ERR_FLAG, 8, 0xA5));
  for (const CanFrame& frame : {extended, standard, error}) {
    CanFrame back;
    ASSERT_TRUE(from_wire(to_wire(frame), back));
    EXPECT_EQ(back, frame);
  }
}

TEST(CanWire, RefusesWhatIsNoClassicDataFrame) {
  CanFrame frame;
  EXPECT_FALSE(from_wire(kernel_bytes(0x123 | CAN_RTR_FLAG, 0, 0), frame));
  EXPECT_FALSE(from_wire(kernel_bytes(0x123, 9, 0), frame));
  EXPECT_FALSE(from_wire(kernel_bytes(0x800, 1, 0), frame));
  const CanWire whole = kernel_bytes(0x123, 1, 0);
  EXPECT_FALSE(from_wire(std::span(whole).first(15), frame));
  EXPECT_FALSE(from_wire({}, frame));
}

}  // namespace
}  // namespace gannet::hal
