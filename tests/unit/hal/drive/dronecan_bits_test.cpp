#include "hal/drive/dronecan_bits.hpp"

#include <gtest/gtest.h>

#include "platform/base/fixed_vector.hpp"
#include "platform/base/random.hpp"

namespace gannet::hal::dronecan {
namespace {

TEST(DroneCanBits, LowByteFirstAndHighBitFirstWithinIt) {
  std::uint8_t bytes[4] = {0xEE, 0xEE, 0xEE, 0xEE};
  BitWriter writer(bytes);
  writer.field(std::uint8_t{1}, 1);        // 1
  writer.field(std::uint16_t{0xABC}, 12);  // 1011 1100, then 1010
  writer.field(std::int16_t{-2}, 3);       // 110
  EXPECT_TRUE(writer.is_good());
  EXPECT_EQ(writer.bytes(), 2);
  EXPECT_EQ(bytes[0], 0b11011110);
  EXPECT_EQ(bytes[1], 0b01010110);
  EXPECT_EQ(bytes[2], 0xEE);
}

TEST(DroneCanBits, FieldsOfEveryWidthComeBack) {
  Random random(4);
  std::uint8_t bytes[512] = {};
  std::int64_t values[64];
  BitWriter writer(bytes);
  for (int bits = 1; bits <= 64; ++bits) {
    values[bits - 1] = static_cast<std::int64_t>(random.next()) >> (64 - bits);
    writer.field(values[bits - 1], bits);
  }
  ASSERT_TRUE(writer.is_good());
  BitReader reader(bytes);
  for (int bits = 1; bits <= 64; ++bits) {
    std::int64_t value = 0;
    reader.field(value, bits);
    EXPECT_EQ(value, values[bits - 1]) << bits;
  }
  EXPECT_TRUE(reader.is_good());
}

TEST(DroneCanBits, AWriterWithoutRoomWritesNoPartOfAField) {
  std::uint8_t bytes[2] = {};
  BitWriter writer{std::span(bytes).first(1)};
  writer.field(std::uint16_t{0xFFFF}, 9);
  EXPECT_FALSE(writer.is_good());
  EXPECT_EQ(bytes[0], 0);
  EXPECT_EQ(bytes[1], 0);
}

TEST(DroneCanBits, AReaderAtTheEndGivesZeroAndSaysSo) {
  const std::uint8_t bytes[1] = {0xFF};
  BitReader reader(bytes);
  std::uint16_t value = 7;
  reader.field(value, 9);
  EXPECT_FALSE(reader.is_good());
  EXPECT_EQ(value, 0);
}

TEST(DroneCanBits, AnArrayLongerThanItsRoomIsRefused) {
  const std::uint8_t bytes[5] = {4, 1, 2, 3, 4};
  const auto each = [](auto& b, auto& item) { b.field(item, 8); };
  FixedVector<std::uint8_t, 4> fits;
  BitReader good(bytes);
  good.array(fits, 8, each);
  EXPECT_TRUE(good.is_good());
  EXPECT_EQ(fits[3], 4);
  FixedVector<std::uint8_t, 3> small;
  BitReader bad(bytes);
  bad.array(small, 8, each);
  EXPECT_FALSE(bad.is_good());
}

}  // namespace
}  // namespace gannet::hal::dronecan
