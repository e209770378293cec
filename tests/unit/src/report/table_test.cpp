#include "src/report/table.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace gannet::report {
namespace {

TEST(Table, aligns_words_left_and_numbers_right) {
  Table sut({"axis", "RMS", "note"});
  sut.add({"x", "1.20", "ok"});
  sut.add({"depth", "12.00", ""});
  EXPECT_EQ(sut.text(),
            "axis     RMS  note\n"
            "─────  ─────  ────\n"
            "x       1.20  ok\n"
            "depth  12.00\n");
}

TEST(Table, counts_letters_not_bytes) {
  Table sut({"unit", "n"});
  sut.add({"µm·rad", "–"});
  sut.add({"mm", "5"});
  EXPECT_EQ(sut.text(),
            "unit    n\n"
            "──────  ─\n"
            "µm·rad  –\n"
            "mm      5\n");
}

TEST(Table, short_rows_are_filled_and_long_ones_cut) {
  Table sut({"a", "b"});
  sut.add({"1"});
  sut.add({"1", "2", "3"});
  EXPECT_EQ(sut.rows()[0].size(), 2u);
  EXPECT_EQ(sut.rows()[1].size(), 2u);
}

TEST(Table, one_word_makes_a_column_words) {
  Table sut({"value"});
  sut.add({"1.5"});
  EXPECT_TRUE(sut.is_numeric(0));
  sut.add({"–"});
  sut.add({"98 %"});
  EXPECT_TRUE(sut.is_numeric(0));
  sut.add({"hit"});
  EXPECT_FALSE(sut.is_numeric(0));
}

TEST(Number, has_fixed_decimals_and_no_minus_zero) {
  EXPECT_EQ(number(1.25, 1), "1.2");  // exactly half goes to even
  EXPECT_EQ(number(1.26, 1), "1.3");
  EXPECT_EQ(number(-0.001, 2), "0.00");
  EXPECT_EQ(number(-1.5, 0), "-2");
  EXPECT_EQ(number(1e300, 0).size(), 301u);
  EXPECT_EQ(number(NAN, 2), "–");
  EXPECT_EQ(number(-INFINITY, 2), "–");
}

}  // namespace
}  // namespace gannet::report
