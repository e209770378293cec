#include "hal/can/can_text.hpp"

#include <gtest/gtest.h>

#include "platform/base/random.hpp"

namespace gannet::hal {
namespace {

TEST(CanText, ReadsAStandardFrame) {
  const auto frame = can_frame_from_text("123#0F00");
  ASSERT_TRUE(frame) << frame.error().text;
  EXPECT_EQ(*frame, (CanFrame{.id = 0x123, .length = 2, .data = {0x0F, 0x00}}));
}

TEST(CanText, ReadsAnExtendedFrameWithDotsAndLowerCase) {
  const auto frame = can_frame_from_text("1f334455#11.22.aa");
  ASSERT_TRUE(frame) << frame.error().text;
  EXPECT_EQ(
      *frame,
      (CanFrame{.id = 0x1F334455, .extended = true, .length = 3, .data = {0x11, 0x22, 0xAA}}));
}

TEST(CanText, EightDigitsAreExtendedEvenWhenTheIdIsSmall) {
  EXPECT_TRUE(can_frame_from_text("00000123#")->extended);
  EXPECT_EQ(to_text(CanFrame{.id = 0x123, .extended = true}), "00000123#");
}

TEST(CanText, ReadsAControllersErrorFrame) {
  const auto frame = can_frame_from_text("20000004#0004000000000000");
  ASSERT_TRUE(frame);
  EXPECT_TRUE(frame->error);
  EXPECT_EQ(frame->id, 4u);
  EXPECT_EQ(to_text(*frame), "20000004#0004000000000000");
}

TEST(CanText, RefusesWhatIsNoFrameAndSaysWhy) {
  const struct {
    const char* text;
    const char* why;
  } cases[] = {
      {"", "no '#'"},
      {"123", "no '#'"},
      {"#00", "3 or 8"},
      {"12#00", "3 or 8"},
      {"12345#00", "3 or 8"},
      {"123456789#00", "3 or 8"},
      {"12G#00", "not hexadecimal"},
      {"-12#00", "not hexadecimal"},
      {"800#00", "at most 7FF"},
      {"FFF#00", "at most 7FF"},
      {"40000000#00", "at most 1FFFFFFF"},
      {"FFFFFFFF#00", "at most 1FFFFFFF"},
      {"123#0", "two hexadecimal digits"},
      {"123#0.0", "not hexadecimal"},
      {"123#.00", "not hexadecimal"},
      {"123#00.", "two hexadecimal digits"},
      {"123#00 ", "two hexadecimal digits"},
      {"123#zz", "not hexadecimal"},
      {"123#000102030405060708", "more than 8"},
      {"123#R", "remote"},
      {"123##10011", "CAN FD"},
  };
  for (const auto& c : cases) {
    const auto frame = can_frame_from_text(c.text);
    ASSERT_FALSE(frame) << c.text;
    EXPECT_NE(frame.error().text.find(c.why), std::string::npos) << frame.error().text;
  }
}

TEST(CanText, AnErrorTextShowsNoControlCharactersAndStaysShort) {
  const auto frame = can_frame_from_text(std::string(1000, '\x1b') + "\n");
  ASSERT_FALSE(frame);
  EXPECT_LT(frame.error().text.size(), 160u);
  EXPECT_EQ(frame.error().text.find_first_of("\x1b\n"), std::string::npos);
}

TEST(CanText, ReadsALogLineOfCandump) {
  const auto line = can_log_line_from_text("(1700000000.123456) vcan0 1004060A#13C0 ");
  ASSERT_TRUE(line) << line.error().text;
  EXPECT_EQ(line->time_us, 1700000000123456);
  EXPECT_EQ(line->interface, "vcan0");
  EXPECT_EQ(to_text(line->frame), "1004060A#13C0");
  EXPECT_EQ(to_text(*line), "(1700000000.123456) vcan0 1004060A#13C0");
}

TEST(CanText, ReadsTheDirectionAndNanosecondsThatCandumpMayWrite) {
  EXPECT_EQ(can_log_line_from_text("(0000000001.5) can0 123# R")->time_us, 1500000);
  EXPECT_EQ(can_log_line_from_text("(1.123456789) can0 123# T")->time_us, 1123456);
}

TEST(CanText, RefusesAMalformedLogLine) {
  for (const char* text :
       {"", "123#00", "(1.5 can0 123#", "(.5) can0 123#", "(1.) can0 123#", "(-1.5) can0 123#",
        "(1.5) can0", "(1.5)", "(1.5) can0 123#0", "(1.5) can0 123# X", "(1.5) can0 123# R more",
        "(9999999999999.5) can0 123#", "(1.5000000000) can0 123#"}) {
    EXPECT_FALSE(can_log_line_from_text(text)) << text;
  }
}

TEST(CanText, RandomFramesComeBackFromTheirText) {
  Random random(7);
  for (int i = 0; i < 5000; ++i) {
    CanFrame frame;
    frame.extended = random.below(2) == 1;
    frame.id = static_cast<std::uint32_t>(random.next()) &
               (frame.extended ? kMaxExtendedId : kMaxStandardId);
    frame.length = static_cast<std::uint8_t>(random.below(9));
    for (int b = 0; b < frame.length; ++b) {
      frame.data[static_cast<std::size_t>(b)] = static_cast<std::uint8_t>(random.next());
    }
    const auto back = can_frame_from_text(to_text(frame));
    ASSERT_TRUE(back);
    ASSERT_EQ(*back, frame);
  }
}

TEST(CanText, MutatedTextIsReadOrRefusedButNeverMisread) {
  Random random(8);
  const std::string good = "(1700000000.123456) can0 1F334455#1122334455667788 R";
  int refused = 0;
  for (int i = 0; i < 5000; ++i) {
    std::string text = good;
    for (int m = random.below(4); m >= 0; --m) {
      const auto at = static_cast<std::size_t>(random.below(static_cast<int>(text.size())));
      if (random.below(2) == 0)
        text[at] = static_cast<char>(random.next());
      else
        text.erase(at, 1);
    }
    const auto line = can_log_line_from_text(text);
    if (!line) {
      ++refused;
      continue;
    }
    const auto again = can_log_line_from_text(to_text(*line));  // what was read can be written
    ASSERT_TRUE(again) << text;
    EXPECT_EQ(again->frame, line->frame);
    EXPECT_EQ(again->time_us, line->time_us);
  }
  EXPECT_GT(refused, 1000);
  EXPECT_LT(refused, 5000);
}

}  // namespace
}  // namespace gannet::hal
