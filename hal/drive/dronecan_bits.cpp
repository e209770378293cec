#include "hal/drive/dronecan_bits.hpp"

#include <algorithm>

namespace gannet::hal::dronecan {

void BitWriter::put(std::uint64_t value, int bits) {
  if (at_ + bits > static_cast<int>(bytes_.size()) * 8) is_good_ = false;
  for (int done = 0; is_good_ && done < bits;) {
    const int in_byte = std::min(8, bits - done);
    for (int bit = in_byte - 1; bit >= 0; --bit, ++at_) {
      std::uint8_t& byte = bytes_[static_cast<std::size_t>(at_ / 8)];
      const auto mask = static_cast<std::uint8_t>(0x80 >> (at_ % 8));
      if (at_ % 8 == 0) byte = 0;
      if ((value >> (done + bit) & 1) != 0) byte = static_cast<std::uint8_t>(byte | mask);
    }
    done += in_byte;
  }
}

std::uint64_t BitReader::get(int bits) {
  if (at_ + bits > static_cast<int>(bytes_.size()) * 8) is_good_ = false;
  std::uint64_t value = 0;
  for (int done = 0; is_good_ && done < bits;) {
    const int in_byte = std::min(8, bits - done);
    for (int bit = in_byte - 1; bit >= 0; --bit, ++at_) {
      const std::uint64_t is_set = bytes_[static_cast<std::size_t>(at_ / 8)] >> (7 - at_ % 8) & 1;
      value |= is_set << (done + bit);
    }
    done += in_byte;
  }
  return value;
}

}  // namespace gannet::hal::dronecan
