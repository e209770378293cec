#include "hal/drive/canopen_frames.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/unit/hal/drive/frames.hpp"

namespace gannet::hal::canopen {
namespace {

CanFrame frame(const char* text) { return frames_from({text}).front(); }

// Ziehl-Abegg, operating instructions AM-CAN-OPEN, 6.3 "Example on services SDO, PDO and NMT".
TEST(CanopenFrames, AreThoseOfAPublishedSession) {
  EXPECT_EQ(to_text(nmt_frame(NmtCommand::kStart, 1)), "000#0101");
  EXPECT_EQ(to_text(nmt_frame(NmtCommand::kResetNode, 1)), "000#8101");
  EXPECT_EQ(to_text(heartbeat_frame(1, NmtState::kPreOperational)), "701#7F");
  EXPECT_EQ(to_text(heartbeat_frame(1, NmtState::kOperational)), "701#05");
  EXPECT_EQ(heartbeat_from(frame("701#7F")), NmtState::kPreOperational);
  EXPECT_EQ(heartbeat_from(frame("701#05")), NmtState::kOperational);
  EXPECT_EQ(emergency_from(frame("081#0000000000000000"))->code, 0);
}

TEST(CanopenFrames, HaveTheIdsOfThePredefinedConnectionSet) {
  EXPECT_EQ(to_text(sync_frame()), "080#");
  EXPECT_EQ(to_text(nmt_frame(NmtCommand::kPreOperational, 0x15)), "000#8015");
  EXPECT_EQ(to_text(nmt_frame(NmtCommand::kResetCommunication, 127)), "000#827F");
  EXPECT_EQ(to_text(nmt_frame(NmtCommand::kStop, 0)), "000#0200");
  EXPECT_EQ(tpdo_base(1), 0x180u);
  EXPECT_EQ(tpdo_base(4), 0x480u);
  EXPECT_EQ(rpdo_base(1), 0x200u);
  EXPECT_EQ(rpdo_base(4), 0x500u);
}

TEST(CanopenFrames, HeartbeatsOfOtherStatesOrLengthsAreNone) {
  EXPECT_EQ(heartbeat_from(frame("701#00")), NmtState::kBootUp);
  EXPECT_EQ(heartbeat_from(frame("701#04")), NmtState::kStopped);
  EXPECT_EQ(heartbeat_from(frame("701#85")), NmtState::kOperational);  // a guarding answer
  EXPECT_FALSE(heartbeat_from(frame("701#03")));
  EXPECT_FALSE(heartbeat_from(frame("701#")));
  EXPECT_FALSE(heartbeat_from(frame("701#0500")));
}

// Faulhaber, "Communications Manual MC 5010", 3.6, the example of a following error.
TEST(CanopenFrames, ReadAPublishedEmergency) {
  const auto e = emergency_from(frame("081#1186200200000000"));
  ASSERT_TRUE(e);
  EXPECT_EQ(e->code, 0x8611);
  EXPECT_EQ(e->error_register, 0x20);
  EXPECT_EQ(e->vendor[0], 0x02);
  EXPECT_STREQ(words_of_emergency(e->code), "following error");
  EXPECT_FALSE(emergency_from(frame("081#11862002000000")));
}

TEST(CanopenFrames, SayEmergenciesInWords) {
  EXPECT_STREQ(words_of_emergency(0x0000), "no error");
  EXPECT_STREQ(words_of_emergency(0x3210), "DC link over-voltage");
  EXPECT_STREQ(words_of_emergency(0x3220), "DC link under-voltage");
  EXPECT_STREQ(words_of_emergency(0x2310), "continuous over-current at the motor");
  EXPECT_STREQ(words_of_emergency(0x4310), "power stage temperature too high");
  EXPECT_STREQ(words_of_emergency(0x7121), "motor blocked");
  EXPECT_STREQ(words_of_emergency(0x8130), "heartbeat lost");
  EXPECT_STREQ(words_of_emergency(0x8250), "RPDO timed out");
  EXPECT_STREQ(words_of_emergency(0x8611), "following error");
  // A code without words of its own has those of its class, by CiA 301.
  EXPECT_STREQ(words_of_emergency(0x2999), "current");
  EXPECT_STREQ(words_of_emergency(0x3999), "voltage");
  EXPECT_STREQ(words_of_emergency(0x4999), "temperature");
  EXPECT_STREQ(words_of_emergency(0xFF42), "the maker's own error");
  EXPECT_STREQ(words_of_emergency(0xA000), "unknown error");
  for (int code = 0; code < 0x10000; ++code) {
    ASSERT_NE(words_of_emergency(static_cast<std::uint16_t>(code)), nullptr);
  }
}

}  // namespace
}  // namespace gannet::hal::canopen
