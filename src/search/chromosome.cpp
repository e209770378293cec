#include "src/search/chromosome.hpp"

#include <algorithm>
#include <cassert>

namespace gannet::search {
namespace {

unsigned gray_from_number(unsigned n) { return n ^ (n >> 1); }

unsigned number_from_gray(unsigned g) {
  for (int shift = 1; shift < 16; shift *= 2) g ^= g >> shift;
  return g;
}

}  // namespace

Coding::Coding(std::span<const int> bits, bool gray)
    : gray_(gray), variables_(static_cast<int>(bits.size())) {
  assert(!bits.empty() && bits.size() <= kMaxDimension);
  for (std::size_t i = 0; i < bits.size(); ++i) {
    bits_[i] = std::clamp(bits[i], 1, 16);
    total_bits_ += bits_[i];
  }
}

void Coding::decode(const Chromosome& chromosome, std::span<float> genes) const {
  for (std::size_t i = 0; i < static_cast<std::size_t>(variables_); ++i) {
    const unsigned code = chromosome.codes[i];
    const unsigned number = gray_ ? number_from_gray(code) : code;
    genes[i] = static_cast<float>(number) / static_cast<float>((1u << bits_[i]) - 1);
  }
}

Chromosome Coding::encode(std::span<const float> genes) const {
  Chromosome result;
  for (std::size_t i = 0; i < static_cast<std::size_t>(variables_); ++i) {
    const float last = static_cast<float>((1u << bits_[i]) - 1);
    const unsigned number = static_cast<unsigned>(fold(genes[i]) * last + 0.5f);
    result.codes[i] = static_cast<std::uint16_t>(gray_ ? gray_from_number(number) : number);
  }
  return result;
}

void Coding::flip(Chromosome& chromosome, int bit) const {
  std::size_t i = 0;
  for (; bit >= bits_[i]; ++i) bit -= bits_[i];
  chromosome.codes[i] =
      static_cast<std::uint16_t>(chromosome.codes[i] ^ (1u << (bits_[i] - 1 - bit)));
}

void Coding::exchange(Chromosome& a, Chromosome& b, int from, int to) const {
  int start = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(variables_); start += bits_[i++]) {
    const int first = std::clamp(from - start, 0, bits_[i]);
    const int last = std::clamp(to - start, first, bits_[i]);
    // Bits first … last − 1, counted from the most significant.
    const unsigned mask = ((1u << (last - first)) - 1) << (bits_[i] - last);
    const unsigned differing = (a.codes[i] ^ b.codes[i]) & mask;
    a.codes[i] = static_cast<std::uint16_t>(a.codes[i] ^ differing);
    b.codes[i] = static_cast<std::uint16_t>(b.codes[i] ^ differing);
  }
}

}  // namespace gannet::search
