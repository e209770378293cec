// BitWriter and BitReader: how DroneCAN lays fields into bytes. A field of n bits goes byte by
// byte, low byte first; within a byte, and for the last byte's n mod 8 bits, high bit first.
// Source: DroneCAN specification, chapter 3 "Data serialization".
//
// Both have the same calls, so that one description of a message serves both ways:
//   field(value, bits)                    unsigned or two's complement, after the value's type
//   half(value)                           float16
//   array(items, count_bits, each)        variable length; count_bits 0: the last field of a
//                                         transfer, whose length follows from the payload's
//                                         ("tail array optimisation")
// A writer saturates a value that does not fit, and is_good() is false if the room was too small.
// A reader's is_good() is false if the payload was too short or an array too long. RT safe.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

#include "hal/drive/float16.hpp"

namespace gannet::hal::dronecan {

class BitWriter {
 public:
  explicit BitWriter(std::span<std::uint8_t> bytes) : bytes_(bytes) {}

  template <class Int>
  void field(const Int& value, int bits) {
    if (bits == 64) return put(static_cast<std::uint64_t>(value), bits);
    constexpr bool is_signed = std::is_signed_v<Int>;
    const std::int64_t highest = (std::int64_t{1} << (bits - (is_signed ? 1 : 0))) - 1;
    const std::int64_t lowest = is_signed ? -highest - 1 : 0;
    const auto wide = static_cast<std::int64_t>(value);
    put(static_cast<std::uint64_t>(wide < lowest ? lowest : wide > highest ? highest : wide), bits);
  }
  void half(const float& value) { put(float16_from(value), 16); }

  template <class Items, class Each>
  void array(const Items& items, int count_bits, Each&& each) {
    if (count_bits > 0) put(static_cast<std::uint64_t>(items.size()), count_bits);
    for (const auto& item : items) each(*this, item);
  }

  bool is_good() const { return is_good_; }
  int bytes() const { return (at_ + 7) / 8; }

 private:
  void put(std::uint64_t value, int bits);

  std::span<std::uint8_t> bytes_;
  int at_ = 0;  // bits written
  bool is_good_ = true;
};

class BitReader {
 public:
  explicit BitReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <class Int>
  void field(Int& value, int bits) {
    std::uint64_t raw = get(bits);
    if (std::is_signed_v<Int> && bits < 64 && (raw >> (bits - 1) & 1) != 0) {
      raw |= ~std::uint64_t{0} << bits;
    }
    value = static_cast<Int>(raw);
  }
  void half(float& value) { value = float_from(static_cast<std::uint16_t>(get(16))); }

  template <class Items, class Each>
  void array(Items& items, int count_bits, Each&& each) {
    items.clear();
    const int count = count_bits > 0 ? static_cast<int>(get(count_bits)) : -1;
    for (int i = 0; is_good_ && (count < 0 ? left() >= 8 : i < count); ++i) {
      std::remove_cvref_t<decltype(items[0])> item = {};
      each(*this, item);
      if (!items.push_back(item)) is_good_ = false;
    }
  }

  // Everything was there, and nothing but the padding of the last byte is left.
  bool is_good() const { return is_good_; }
  int left() const { return static_cast<int>(bytes_.size()) * 8 - at_; }

 private:
  std::uint64_t get(int bits);

  std::span<const std::uint8_t> bytes_;
  int at_ = 0;  // bits read
  bool is_good_ = true;
};

}  // namespace gannet::hal::dronecan
