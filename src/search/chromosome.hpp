// Chromosome: the binary string of the papers' genetic algorithm (P001 §2.6, P002 Eq. 7, P004
// §3.3): one number of a few bits for each variable, side by side. Bit 0 of the string is the
// first variable's most significant. Values; RT safe.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "src/search/population.hpp"

namespace gannet::search {

struct Chromosome {
  std::array<std::uint16_t, kMaxDimension> codes = {};
  bool operator==(const Chromosome&) const = default;
};

class Coding {
 public:
  // 1 … 8 variables of 1 … 16 bits each. gray: neighbouring numbers differ by one bit.
  Coding(std::span<const int> bits, bool gray);

  int variables() const { return variables_; }
  int bits() const { return total_bits_; }
  int bits(int variable) const { return bits_[static_cast<std::size_t>(variable)]; }

  // Number k of a variable with b bits is the gene k / (2^b − 1); encode takes the nearest.
  void decode(const Chromosome& chromosome, std::span<float> genes) const;
  Chromosome encode(std::span<const float> genes) const;

  void flip(Chromosome& chromosome, int bit) const;
  // Exchanges the bits from … to − 1 of the string.
  void exchange(Chromosome& a, Chromosome& b, int from, int to) const;

 private:
  bool gray_;
  int variables_;
  int total_bits_ = 0;
  std::array<int, kMaxDimension> bits_ = {};
};

}  // namespace gannet::search
