#include "hal/drive/canopen_sdo.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <set>
#include <string>

#include "platform/base/random.hpp"
#include "tests/unit/hal/drive/frames.hpp"

namespace gannet::hal::canopen {
namespace {

using std::chrono::milliseconds;

constexpr TimePoint kStart = time_from_ns(1'000'000'000);

CanFrame frame(const char* text) { return frames_from({text}).front(); }
std::string polled(SdoClient& sut, TimePoint now) {
  const auto request = sut.poll(now);
  return request ? to_text(*request) : "";
}

// Baumüller, parameter manual b maXX 1000 (5.07004.03), page 181: 5 to object 6060 of node 4.
TEST(CanopenSdo, WritesAsInAPublishedExample) {
  SdoClient sut(4, milliseconds(100));
  sut.write({0x6060, 0}, 5, 1);
  EXPECT_EQ(polled(sut, kStart), "604#2F60600005000000");
  EXPECT_TRUE(sut.receive(frame("584#6060600000000000")));
  EXPECT_EQ(sut.status(), SdoStatus::kDone);
}

// Festo, manual CiA 402 for motor controllers CMMS/CMMD (GDCP-CMMS/D-C-CO), page 20.
TEST(CanopenSdo, ReadsAsInPublishedExamples) {
  SdoClient sut(1, milliseconds(100));
  sut.read({0x6061, 0});
  EXPECT_EQ(polled(sut, kStart), "601#4061600000000000");
  EXPECT_TRUE(sut.receive(frame("581#4F61600001000000")));
  EXPECT_EQ(sut.value(), 1u);
  EXPECT_EQ(sut.bytes(), 1);
  sut.read({0x6041, 0});
  EXPECT_EQ(polled(sut, kStart), "601#4041600000000000");
  EXPECT_TRUE(sut.receive(frame("581#4B41600034120000")));
  EXPECT_EQ(sut.value(), 0x1234u);
  EXPECT_EQ(sut.bytes(), 2);
  sut.read({0x6093, 1});
  EXPECT_EQ(polled(sut, kStart), "601#4093600100000000");
  EXPECT_TRUE(sut.receive(frame("581#4393600178563412")));
  EXPECT_EQ(sut.value(), 0x12345678u);
  EXPECT_EQ(sut.bytes(), 4);
  EXPECT_EQ(to_text(sdo_write_request(1, {0x1401, 2}, 0xEF, 1)), "601#2F011402EF000000");
  EXPECT_EQ(to_text(sdo_write_request(1, {0x6040, 0}, 0x03E8, 2)), "601#2B406000E8030000");
  EXPECT_EQ(to_text(sdo_write_request(1, {0x6093, 1}, 0x12345678, 4)), "601#2393600178563412");
}

// A CODESYS master telling node 2 to watch the heartbeat of node 127, 300 ms (published capture).
TEST(CanopenSdo, WritesTheConsumerHeartbeatOfAPublishedCapture) {
  EXPECT_EQ(to_text(sdo_write_request(2, {0x1016, 1}, 127u << 16 | 300, 4)),
            "602#231610012C017F00");
}

TEST(CanopenSdo, NegativeNumbersAreCutToTheirLength) {
  EXPECT_EQ(to_text(sdo_write_request(1, {0x60C2, 2}, static_cast<std::uint32_t>(-3), 1)),
            "601#2FC26002FD000000");
}

TEST(CanopenSdo, SendsNothingWithoutARequestAndEachOnce) {
  SdoClient sut(1, milliseconds(100));
  EXPECT_FALSE(sut.poll(kStart));
  sut.read({0x1000, 0});
  EXPECT_TRUE(sut.poll(kStart));
  EXPECT_FALSE(sut.poll(kStart + milliseconds(99)));
}

TEST(CanopenSdo, RepeatsTwiceThenGivesUpWithAnAbort) {
  SdoClient sut(1, milliseconds(100));
  sut.read({0x1000, 0});
  EXPECT_EQ(polled(sut, kStart), "601#4000100000000000");
  EXPECT_EQ(polled(sut, kStart + milliseconds(100)), "601#4000100000000000");
  EXPECT_EQ(polled(sut, kStart + milliseconds(200)), "601#4000100000000000");
  EXPECT_EQ(sut.status(), SdoStatus::kWaiting);
  EXPECT_EQ(polled(sut, kStart + milliseconds(300)), "601#8000100000000405");
  EXPECT_EQ(sut.status(), SdoStatus::kTimedOut);
  EXPECT_EQ(sut.abort_code(), kAbortTimedOut);
  EXPECT_FALSE(sut.poll(kStart + milliseconds(400)));
}

TEST(CanopenSdo, TakesALateAnswerToARepeatedRequestOnce) {
  SdoClient sut(1, milliseconds(100));
  sut.read({0x6041, 0});
  sut.poll(kStart);
  sut.poll(kStart + milliseconds(100));
  sut.receive(frame("581#4B41600034120000"));
  EXPECT_EQ(sut.status(), SdoStatus::kDone);
  EXPECT_TRUE(sut.receive(frame("581#4B41600035120000")));
  EXPECT_EQ(sut.value(), 0x1234u);
  EXPECT_EQ(sut.unexpected(), 1u);
}

TEST(CanopenSdo, IgnoresAnswersAboutOtherObjectsOrOfTheOtherKind) {
  SdoClient sut(1, milliseconds(100));
  EXPECT_TRUE(sut.receive(frame("581#4B41600034120000")));  // nobody asked
  sut.write({0x6040, 0}, 6, 2);
  EXPECT_TRUE(sut.receive(frame("581#6040600000000000")));  // before it was sent
  sut.poll(kStart);
  EXPECT_TRUE(sut.receive(frame("581#6041600000000000")));
  EXPECT_TRUE(sut.receive(frame("581#6040600100000000")));
  EXPECT_TRUE(sut.receive(frame("581#4B40600006000000")));
  EXPECT_EQ(sut.status(), SdoStatus::kWaiting);
  EXPECT_EQ(sut.unexpected(), 5u);
  sut.read({0x6040, 0});
  sut.poll(kStart);
  EXPECT_TRUE(sut.receive(frame("581#6040600000000000")));
  EXPECT_EQ(sut.status(), SdoStatus::kWaiting);
}

TEST(CanopenSdo, EndsWithTheAbortCodeOfTheNode) {
  SdoClient sut(1, milliseconds(100));
  sut.write({0x6007, 0}, 3, 2);
  sut.poll(kStart);
  EXPECT_TRUE(sut.receive(frame("581#8007600000000206")));
  EXPECT_EQ(sut.status(), SdoStatus::kAborted);
  EXPECT_EQ(sut.abort_code(), kAbortNoObject);
  EXPECT_STREQ(words_of_abort(sut.abort_code()), "the object does not exist");
}

TEST(CanopenSdo, RefusesASegmentedAnswerAndTellsTheNode) {
  SdoClient sut(1, milliseconds(100));
  sut.read({0x1008, 0});
  sut.poll(kStart);
  EXPECT_TRUE(sut.receive(frame("581#410810001B000000")));
  EXPECT_EQ(sut.status(), SdoStatus::kAborted);
  EXPECT_EQ(polled(sut, kStart), "601#8008100010000706");
  EXPECT_FALSE(sut.poll(kStart));
}

TEST(CanopenSdo, TakesAnswersThatSayNoSizeOrAreShort) {
  SdoClient sut(1, milliseconds(100));
  sut.read({0x1000, 0});
  sut.poll(kStart);
  EXPECT_TRUE(sut.receive(frame("581#4200100092010200")));
  EXPECT_EQ(sut.value(), 0x00020192u);
  sut.write({0x6060, 0}, 3, 1);
  sut.poll(kStart);
  EXPECT_TRUE(sut.receive(frame("581#60606000")));
  EXPECT_EQ(sut.status(), SdoStatus::kDone);
}

TEST(CanopenSdo, CountsTruncatedAnswersAsMalformed) {
  SdoClient sut(1, milliseconds(100));
  sut.read({0x1000, 0});
  sut.poll(kStart);
  EXPECT_FALSE(sut.receive(frame("581#")));
  EXPECT_FALSE(sut.receive(frame("581#430010")));
  EXPECT_FALSE(sut.receive(frame("581#43001000920102")));
  EXPECT_FALSE(sut.receive(frame("581#800010000000")));
  EXPECT_EQ(sut.status(), SdoStatus::kWaiting);
}

TEST(CanopenSdo, SurvivesAnyBytes) {
  SdoClient sut(1, milliseconds(10));
  Random random(7);
  for (int i = 0; i < 200000; ++i) {
    if (random.below(4) == 0) sut.read({0x6041, 0});
    if (random.below(4) == 0) sut.write({0x6040, 0}, 1, 2);
    sut.poll(kStart + milliseconds(i));
    CanFrame any = {.id = 0x581, .length = static_cast<std::uint8_t>(random.below(9))};
    for (std::uint8_t& byte : any.data) byte = static_cast<std::uint8_t>(random.next());
    if (random.below(2) == 0) any.data[1] = 0x41, any.data[2] = 0x60, any.data[3] = 0;
    sut.receive(any);
    ASSERT_LE(sut.bytes(), 4);
  }
}

TEST(CanopenSdo, HasWordsForEveryAbortCode) {
  std::set<std::string> words;
  for (const std::uint32_t code :
       {kAbortTimedOut, kAbortBadCommand, kAbortUnsupported, kAbortWriteOnly, kAbortReadOnly,
        kAbortNoObject, kAbortNotMappable, kAbortPdoTooLong, kAbortIncompatible, kAbortWrongLength,
        kAbortNoSub, kAbortOutOfRange, kAbortWrongState}) {
    words.insert(words_of_abort(code));
  }
  EXPECT_EQ(words.size(), 13u);
  EXPECT_STREQ(words_of_abort(0x12345678), "unknown abort code");
}

}  // namespace
}  // namespace gannet::hal::canopen
