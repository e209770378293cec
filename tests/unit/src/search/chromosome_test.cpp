#include "src/search/chromosome.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace gannet::search {
namespace {

constexpr std::array<int, 6> kSixGenes = {12, 12, 12, 12, 12, 12};
constexpr std::array<int, 3> kThreeGenes = {10, 7, 7};

int differing_bits(const Chromosome& a, const Chromosome& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.codes.size(); ++i) {
    count += __builtin_popcount(static_cast<unsigned>(a.codes[i] ^ b.codes[i]));
  }
  return count;
}

TEST(Coding, has_the_papers_lengths) {
  EXPECT_EQ(Coding(kSixGenes, false).bits(), 72);
  EXPECT_EQ(Coding(kThreeGenes, false).bits(), 24);
}

TEST(Coding, every_number_of_every_variable_goes_there_and_back) {
  for (const bool gray : {false, true}) {
    const Coding sut(kThreeGenes, gray);
    for (int k = 0; k < 1024; ++k) {
      const std::array<float, 3> genes = {static_cast<float>(k) / 1023,
                                          static_cast<float>(k % 128) / 127,
                                          static_cast<float>(127 - k % 128) / 127};
      std::array<float, 3> back;
      sut.decode(sut.encode(genes), back);
      EXPECT_EQ(genes, back) << k;
    }
  }
}

TEST(Coding, a_gene_comes_back_within_half_a_step) {
  Random random(4);
  for (const bool gray : {false, true}) {
    const Coding sut(kSixGenes, gray);
    for (int i = 0; i < 300; ++i) {
      std::array<float, 6> genes;
      draw_anywhere(random, genes);
      std::array<float, 6> back;
      sut.decode(sut.encode(genes), back);
      for (std::size_t g = 0; g < 6; ++g) EXPECT_NEAR(genes[g], back[g], 0.5001f / 4095);
    }
  }
}

TEST(Coding, plain_binary_has_the_most_significant_bit_first) {
  const Coding sut(kThreeGenes, false);
  Chromosome c;
  sut.flip(c, 0);
  EXPECT_EQ(c.codes[0], 512);
  sut.flip(c, 9);
  EXPECT_EQ(c.codes[0], 513);
  sut.flip(c, 10);
  EXPECT_EQ(c.codes[1], 64);
  sut.flip(c, 23);
  EXPECT_EQ(c.codes[2], 1);
}

TEST(Coding, gray_neighbours_differ_by_one_bit) {
  const Coding sut(kThreeGenes, true);
  for (int k = 0; k < 1023; ++k) {
    const std::array<float, 3> here = {static_cast<float>(k) / 1023, 0, 0};
    const std::array<float, 3> next = {static_cast<float>(k + 1) / 1023, 0, 0};
    EXPECT_EQ(differing_bits(sut.encode(here), sut.encode(next)), 1) << k;
  }
}

TEST(Coding, exchange_swaps_the_bits_between_two_cuts_and_no_other) {
  const Coding sut(kSixGenes, false);
  Chromosome zeros;
  Chromosome ones;
  for (std::size_t i = 0; i < 6; ++i) ones.codes[i] = 0xfff;
  for (const auto& [from, to] : {std::pair{0, 72}, {0, 1}, {71, 72}, {5, 30}, {12, 24}, {7, 7}}) {
    Chromosome a = zeros;
    Chromosome b = ones;
    sut.exchange(a, b, from, to);
    // The truth, bit by bit.
    Chromosome expected = zeros;
    for (int bit = from; bit < to; ++bit) sut.flip(expected, bit);
    EXPECT_EQ(a, expected) << from << " … " << to;
    EXPECT_EQ(differing_bits(a, b), 72);
    sut.exchange(a, b, from, to);
    EXPECT_EQ(a, zeros);
  }
}

TEST(Coding, sixteen_bits_fit) {
  const std::array<int, 8> bits = {16, 16, 16, 16, 16, 16, 16, 16};
  const Coding sut(bits, false);
  std::array<float, 8> genes;
  genes.fill(1);
  std::array<float, 8> back;
  sut.decode(sut.encode(genes), back);
  EXPECT_EQ(genes, back);
  EXPECT_EQ(sut.bits(), 128);
}

}  // namespace
}  // namespace gannet::search
