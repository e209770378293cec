#include "hal/drive/dronecan_transfer.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "platform/base/random.hpp"
#include "tests/unit/hal/drive/frames.hpp"

namespace gannet::hal::dronecan {
namespace {

using std::chrono::milliseconds;

constexpr std::uint64_t kSignature = 0x1122334455667788;
constexpr TimePoint at_ms(std::int64_t ms) { return TimePoint(milliseconds(ms)); }

class TransferReceiverTest : public testing::Test {
 protected:
  // The frames of a payload 0, 1, 2 … of this size from a node.
  static std::vector<CanFrame> transfer(int size, int id, int source = 5) {
    std::vector<std::uint8_t> payload(static_cast<std::size_t>(size));
    std::iota(payload.begin(), payload.end(), std::uint8_t{0});
    std::vector<CanFrame> frames(static_cast<std::size_t>(frames_of(size)));
    const TransferHeader header = {.type_id = 1000,
                                   .source = static_cast<std::uint8_t>(source),
                                   .transfer_id = static_cast<std::uint8_t>(id)};
    EXPECT_EQ(disassemble(header, kSignature, payload, frames), frames_of(size));
    return frames;
  }
  // How many transfers these frames complete.
  int receive(std::span<const CanFrame> frames, TimePoint time = at_ms(0)) {
    int completed = 0;
    for (const CanFrame& frame : frames) {
      if (const auto done = sut_.receive(frame, time)) {
        ++completed;
        size_ = static_cast<int>(done->payload.size());
      }
    }
    return completed;
  }
  const TransferCounters& counters() const { return sut_.counters(); }

  TransferReceiver sut_{
      {{TransferKind::kMessage, 1000, kSignature}, {TransferKind::kRequest, 7, kSignature}}, 10};
  int size_ = -1;
};

TEST(TransferCrc, IsThatOfTheSpecification) {
  // CRC-16-CCITT-FALSE of "123456789" is 0x29B1: as signature the first eight of them.
  const std::uint8_t nine[] = {'9'};
  EXPECT_EQ(transfer_crc(0x3837363534333231, nine), 0x29B1);
}

TEST_F(TransferReceiverTest, PayloadsOfEverySizeComeBack) {
  int id = 0;
  for (int size = 0; size <= kMaxPayload; ++size, id = (id + 1) % 32) {
    ASSERT_EQ(receive(transfer(size, id)), 1) << size;
    ASSERT_EQ(size_, size);
  }
  EXPECT_EQ(counters().malformed + counters().lost + counters().repeated, 0u);
}

TEST_F(TransferReceiverTest, ARepeatedTransferIsTakenOnce) {
  EXPECT_EQ(receive(transfer(3, 4)), 1);
  EXPECT_EQ(receive(transfer(3, 4)), 0);
  EXPECT_EQ(counters().repeated, 1u);
}

TEST_F(TransferReceiverTest, EachRepeatedFrameIsSkipped) {
  std::vector<CanFrame> doubled;
  for (const CanFrame& frame : transfer(30, 4)) doubled.insert(doubled.end(), 2, frame);
  EXPECT_EQ(receive(doubled), 1);
  EXPECT_EQ(size_, 30);
  EXPECT_EQ(counters().repeated, doubled.size() / 2);
}

TEST_F(TransferReceiverTest, ALostFrameCostsThatTransferAlone) {
  const auto whole = transfer(30, 4);
  for (std::size_t lost = 0; lost < whole.size(); ++lost) {
    TransferReceiver fresh({{TransferKind::kMessage, 1000, kSignature}}, 10);
    sut_ = std::move(fresh);
    EXPECT_EQ(receive(transfer(30, 3)), 1);
    auto frames = whole;
    frames.erase(frames.begin() + static_cast<std::ptrdiff_t>(lost));
    EXPECT_EQ(receive(frames), 0) << lost;
    EXPECT_EQ(receive(transfer(30, 5)), 1) << lost;
    // Lost in the middle, the toggle lets the rest pass and the CRC tells.
    EXPECT_EQ(counters().incomplete + counters().lost + counters().malformed, 1u) << lost;
  }
}

TEST_F(TransferReceiverTest, MissingTransfersAreCounted) {
  receive(transfer(3, 30));
  EXPECT_EQ(receive(transfer(3, 2)), 1);  // 31, 0 and 1 are missing
  EXPECT_EQ(counters().lost, 3u);
}

TEST_F(TransferReceiverTest, AChangedByteIsNoticedByTheCrc) {
  auto frames = transfer(30, 4);
  frames[2].data[3] ^= 1;
  EXPECT_EQ(receive(frames), 0);
  EXPECT_EQ(counters().malformed, 1u);
  EXPECT_EQ(receive(transfer(30, 5)), 1);
}

TEST_F(TransferReceiverTest, AnotherTypesSignatureIsNoticed) {
  TransferReceiver other({{TransferKind::kMessage, 1000, kSignature + 1}}, 10);
  for (const CanFrame& frame : transfer(30, 4)) EXPECT_FALSE(other.receive(frame, at_ms(0)));
  EXPECT_EQ(other.counters().malformed, 1u);
}

TEST_F(TransferReceiverTest, AfterTwoSecondsOfSilenceTheSameIdIsNew) {
  EXPECT_EQ(receive(transfer(3, 4), at_ms(0)), 1);
  EXPECT_EQ(receive(transfer(3, 4), at_ms(2000)), 0);
  EXPECT_EQ(receive(transfer(3, 4), at_ms(2001)), 1);
}

TEST_F(TransferReceiverTest, AnUnfinishedTransferIsGivenUpAfterTwoSeconds) {
  const auto frames = transfer(30, 4);
  receive(std::span(frames).first(2), at_ms(0));
  EXPECT_EQ(receive(std::span(frames).subspan(2), at_ms(2001)), 0);
  EXPECT_EQ(counters().incomplete, 1u);
  EXPECT_EQ(receive(transfer(30, 5), at_ms(2002)), 1);
}

TEST_F(TransferReceiverTest, SourcesDoNotDisturbEachOther) {
  const auto a = transfer(30, 4, 1), b = transfer(30, 9, 2);
  int completed = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    completed += receive(std::span(a).subspan(i, 1)) + receive(std::span(b).subspan(i, 1));
  }
  EXPECT_EQ(completed, 2);
}

TEST_F(TransferReceiverTest, MoreSourcesThanSessionsAreCountedAndTheOldPlacesTaken) {
  TransferReceiver small({{TransferKind::kMessage, 1000, kSignature}}, 10, 2);
  for (int source : {1, 2, 3}) {
    const auto frames = transfer(3, 0, source);
    EXPECT_EQ(small.receive(frames[0], at_ms(0)).has_value(), source < 3);
  }
  EXPECT_EQ(small.counters().no_room, 1u);
  EXPECT_TRUE(small.receive(transfer(3, 0, 3)[0], at_ms(3000)));
}

TEST_F(TransferReceiverTest, ServicesToOthersAreIgnored) {
  for (int to : {10, 11}) {
    const TransferHeader header = {.kind = TransferKind::kRequest,
                                   .type_id = 7,
                                   .source = 5,
                                   .destination = static_cast<std::uint8_t>(to)};
    CanFrame frame[1];
    disassemble(header, kSignature, {}, frame);
    EXPECT_EQ(receive(frame), to == 10 ? 1 : 0);
    EXPECT_EQ(filter_for({TransferKind::kRequest, 7, kSignature}, 10).matches(frame[0]), to == 10);
  }
}

TEST_F(TransferReceiverTest, WhatIsNoDroneCanIsIgnoredOrCounted) {
  EXPECT_EQ(receive(frames_from({"123#C0", "20000004#00"})), 0);
  EXPECT_EQ(counters().malformed, 0u);
  receive(frames_from({
      "1003E805#",        // no tail byte
      "1003E805#00E0",    // a start with the toggle set
      "1003E805#008001",  // not full, and not the last
      "1003E880#C0",      // a service of nobody
  }));
  EXPECT_EQ(counters().malformed, 4u);
}

TEST_F(TransferReceiverTest, ATransferLongerThanAnyTypeIsRefusedAndTheNextTaken) {
  std::vector<CanFrame> frames(60, transfer(30, 4)[1]);
  frames[0] = transfer(30, 4)[0];
  for (std::size_t i = 1; i < frames.size(); ++i) {
    frames[i].data[7] = static_cast<std::uint8_t>(4 | (i % 2 == 1 ? 0x20 : 0));
  }
  EXPECT_EQ(receive(frames), 0);
  EXPECT_EQ(counters().malformed, 1u);
  EXPECT_EQ(receive(transfer(30, 5)), 1);
}

TEST(Disassemble, RefusesWhatHasNoRoomOrNoFormInsteadOfWritingAPart) {
  const std::uint8_t payload[20] = {};
  CanFrame frames[4];
  EXPECT_EQ(disassemble({.type_id = 1, .source = 1}, 0, payload, std::span(frames).first(3)), 0);
  EXPECT_EQ(disassemble({.type_id = 1, .source = 1}, 0, payload, frames), 4);
  EXPECT_EQ(disassemble({.type_id = 1, .source = 0}, 0, payload, frames), 0);
}

TEST(FilterFor, PassesATypeFromAllSourcesAndNothingElse) {
  const CanFilter status = filter_for({TransferKind::kMessage, 1034, 0}, 10);
  EXPECT_TRUE(status.matches(frames_from({"10040A15#C0"})[0]));
  EXPECT_TRUE(status.matches(frames_from({"04040A7F#C0"})[0]));
  EXPECT_FALSE(status.matches(frames_from({"10040B15#C0"})[0]));
  EXPECT_FALSE(status.matches(frames_from({"10040A95#C0"})[0]));
  EXPECT_FALSE(status.matches(frames_from({"40A#C0"})[0]));
  const CanFilter allocation = filter_for({TransferKind::kMessage, 1, 0}, 10);
  EXPECT_TRUE(allocation.matches(frames_from({"1048D100#C0"})[0]));  // with a discriminator
  EXPECT_TRUE(allocation.matches(frames_from({"1000017F#C0"})[0]));
}

// Any mix of good, mutated, lost, repeated and random frames: nothing breaks, and no payload comes
// out that nobody sent (each is 0, 1, 2 … by the sender's rule, single frames have no CRC).
TEST_F(TransferReceiverTest, SurvivesMutatedFrames) {
  Random random(11);
  int completed = 0;
  for (int i = 0; i < 5000; ++i) {
    auto frames = transfer(random.below(60), i % 32, 1 + random.below(5));
    for (CanFrame& frame : frames) {
      const int fate = random.below(20);
      if (fate == 0) continue;
      if (fate == 1) frame.data[static_cast<std::size_t>(random.below(8))] ^= 1 << random.below(8);
      if (fate == 2) frame.length = static_cast<std::uint8_t>(random.below(9));
      if (fate == 3) frame.id ^= 1u << random.below(29);
      const auto done = sut_.receive(frame, at_ms(i));
      if (!done) continue;
      ++completed;
      if (done->payload.size() <= 7) continue;
      for (std::size_t b = 0; b < done->payload.size(); ++b) ASSERT_EQ(done->payload[b], b);
    }
  }
  EXPECT_GT(completed, 1000);
  EXPECT_GT(counters().malformed, 100u);
}

TEST_F(TransferReceiverTest, SurvivesRandomFrames) {
  Random random(12);
  for (int i = 0; i < 20000; ++i) {
    CanFrame frame = {.id = static_cast<std::uint32_t>(random.next()) & kMaxExtendedId,
                      .extended = true,
                      .length = static_cast<std::uint8_t>(random.below(9))};
    if (random.below(2) == 0) frame.id = 0x1003E800u | (frame.id & 0x7F);
    for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(random.next());
    if (const auto done = sut_.receive(frame, at_ms(i))) {
      ASSERT_LE(done->payload.size(), static_cast<std::size_t>(kMaxPayload));
    }
  }
}

}  // namespace
}  // namespace gannet::hal::dronecan
