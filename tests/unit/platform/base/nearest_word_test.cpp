#include "platform/base/nearest_word.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gannet {
namespace {

const std::vector<std::string> kKnown = {"population", "optimiser", "seed", "evaluations"};

TEST(EditDistance, counts_each_kind_of_slip_once) {
  EXPECT_EQ(edit_distance("seed", "seed"), 0);
  EXPECT_EQ(edit_distance("seed", "sed"), 1);    // left out
  EXPECT_EQ(edit_distance("seed", "seeed"), 1);  // too many
  EXPECT_EQ(edit_distance("seed", "seid"), 1);   // replaced
  EXPECT_EQ(edit_distance("seed", "esed"), 1);   // swapped
  EXPECT_EQ(edit_distance("", "seed"), 4);
}

TEST(EditDistance, is_symmetric) {
  for (const auto& a : kKnown) {
    for (const auto& b : kKnown) EXPECT_EQ(edit_distance(a, b), edit_distance(b, a));
  }
}

TEST(NearestWord, finds_what_was_meant) {
  EXPECT_EQ(nearest_word("optimizer", kKnown), "optimiser");
  EXPECT_EQ(nearest_word("poplation", kKnown), "population");
  EXPECT_EQ(nearest_word("evalutaion", kKnown), "evaluations");
}

TEST(NearestWord, suggests_nothing_far_off) {
  EXPECT_EQ(nearest_word("gravity", kKnown), "");
  EXPECT_EQ(nearest_word("anything", std::vector<std::string>{}), "");
}

}  // namespace
}  // namespace gannet
