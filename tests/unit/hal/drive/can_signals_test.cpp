#include "hal/drive/can_signals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hal/drive/odrive_messages.hpp"
#include "hal/drive/vesc_messages.hpp"
#include "platform/base/random.hpp"
#include "tests/unit/hal/drive/frames.hpp"

namespace gannet::hal {
namespace {

double read(const char* text, const Signal& signal, ByteOrder order) {
  return read_signal(signal, order, frames_from({text})[0]);
}

// The example of the firmware's own documentation (comm_can.md): 51 A to the VESC with id 23.
TEST(CanSignals, WritesThePublishedCommandOfVesc) {
  const CanFrame frame = vesc::set_frame(vesc::kSetCurrent, vesc::kCurrent, 23, 51);
  EXPECT_EQ(to_text(frame), "00000117#0000C738");
}

// What another decoder's tests pack and expect: 20620 rpm, 12.3 A, 0.065.
TEST(CanSignals, ReadsVescStatusAsOthersDo) {
  const char* text = "00000907#0000508C007B0041";
  EXPECT_DOUBLE_EQ(read(text, vesc::kStatus1[0], vesc::kOrder), 20620);
  EXPECT_NEAR(read(text, vesc::kStatus1[1], vesc::kOrder), 12.3, 1e-12);
  EXPECT_NEAR(read(text, vesc::kStatus1[2], vesc::kOrder), 0.065, 1e-12);
  EXPECT_NEAR(read("00000907#FFFFAF74FF85FFBF", vesc::kStatus1[0], vesc::kOrder), -20620, 1e-12);
}

// Frames of a user's axis 63, as candump showed them: closed loop, then 12.18486 V on the bus.
TEST(CanSignals, ReadsCapturedFramesOfAnOdrive) {
  EXPECT_EQ(read("7E1#0000000008000000", odrive::kState, odrive::kOrder), odrive::kClosedLoop);
  EXPECT_NEAR(read("7F7#33F5424100000000", odrive::kBus[0], odrive::kOrder), 12.184863, 1e-6);
  EXPECT_EQ(odrive::id_of(odrive::kGetBus, 63), 0x7F7u);
}

// As a DBC library encodes it: error 1, state 11.
TEST(CanSignals, ReadsAHeartbeatAsOthersEncodeIt) {
  EXPECT_EQ(read("001#010000000B000000", odrive::kError, odrive::kOrder), 1);
  EXPECT_EQ(read("001#010000000B000000", odrive::kState, odrive::kOrder), 11);
}

TEST(CanSignals, WhatIsWrittenIsReadAgain) {
  Random random(1);
  const auto check = [&](std::span<const MessageAbout> messages, ByteOrder order) {
    for (const MessageAbout& message : messages) {
      for (const Signal& signal : message.signals) {
        const bool is_float = signal.coding == Coding::kFloat;
        const double span = is_float ? 1e6 : std::ldexp(signal.scale, 8 * signal.bytes - 1);
        const double low = signal.coding == Coding::kUnsigned ? 0 : -span;
        for (int i = 0; i < 50; ++i) {
          const double value = low + (span - low) * 0.999 * random.uniform();
          CanFrame frame = {.length = 8};
          write_signal(signal, order, value, frame);
          EXPECT_NEAR(read_signal(signal, order, frame), value, is_float ? 0.1 : signal.scale / 2)
              << message.name << " " << signal.name;
        }
      }
    }
  };
  check(vesc::kMessages, vesc::kOrder);
  check(odrive::kMessages, odrive::kOrder);
}

TEST(CanSignals, KeepsToWhatASignalCanHold) {
  constexpr Signal kSmall = {"Small", 2, 2, Coding::kSigned, 0.1, "A"};
  constexpr Signal kByte = {"Byte", 0, 1, Coding::kUnsigned, 1, ""};
  const auto written = [](const Signal& signal, double value) {
    CanFrame frame = {.length = 8};
    write_signal(signal, ByteOrder::kBigEndian, value, frame);
    return to_text(frame);
  };
  EXPECT_EQ(written(kSmall, 1e9), "000#00007FFF00000000");
  EXPECT_EQ(written(kSmall, -1e9), "000#0000800000000000");
  EXPECT_EQ(written(kSmall, std::numeric_limits<double>::quiet_NaN()), "000#0000000000000000");
  EXPECT_EQ(written(kByte, -1), "000#0000000000000000");
  EXPECT_EQ(written(kByte, 300), "000#FF00000000000000");
  EXPECT_EQ(read("000#01", {"Wide", 0, 4, Coding::kUnsigned, 1, ""}, ByteOrder::kLittleEndian), 1);
}

TEST(CanSignals, SignalsFitTheirMessagesAndDoNotOverlap) {
  const auto check = [](std::span<const MessageAbout> messages) {
    for (const MessageAbout& message : messages) {
      unsigned taken = 0;
      for (const Signal& signal : message.signals) {
        EXPECT_LE(signal.byte + signal.bytes, message.length) << message.name << " " << signal.name;
        const unsigned bytes = ((1u << signal.bytes) - 1) << signal.byte;
        EXPECT_EQ(taken & bytes, 0u) << message.name << " " << signal.name;
        taken |= bytes;
      }
    }
  };
  check(vesc::kMessages);
  check(odrive::kMessages);
}

// Start bits, byte orders and flags are where Vector's format wants them.
TEST(CanSignals, DbcSaysWhereSignalsLie) {
  const std::string vesc = vesc::dbc_text(), odrive = odrive::dbc_text();
  const auto has = [](const std::string& text, const char* part) {
    EXPECT_NE(text.find(part), std::string::npos) << part;
  };
  has(vesc, "BO_ 2147485953 Vesc1_Status: 8 Vesc1\n");  // 0x80000901
  has(vesc, " SG_ ElectricalSpeed : 7|32@0- (1,0) [0|0] \"rpm\" Gannet\n");
  has(vesc, " SG_ MotorCurrent : 39|16@0- (0.1,0) [0|0] \"A\" Gannet\n");
  has(odrive, "BO_ 33 Odrive1_Heartbeat: 8 Odrive1\n");
  has(odrive, " SG_ AxisState : 32|8@1+ (1,0) [0|0] \"\" Gannet\n");
  has(odrive, "SIG_VALTYPE_ 41 Velocity : 1;\n");
}

}  // namespace
}  // namespace gannet::hal
