#include "src/control/line_buffer.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace gannet::control {
namespace {

std::vector<std::string> lines_of(LineBuffer& sut) {
  std::vector<std::string> lines;
  std::string line;
  for (auto next = sut.next(line); next != LineBuffer::Next::kNothing; next = sut.next(line)) {
    lines.push_back(next == LineBuffer::Next::kLine ? line : "too long");
  }
  return lines;
}

using Lines = std::vector<std::string>;

TEST(LineBuffer, puts_lines_together_from_pieces) {
  LineBuffer sut(10);
  sut.append("ab");
  EXPECT_EQ(lines_of(sut), Lines{});
  sut.append("c\n\nde");
  EXPECT_EQ(lines_of(sut), (Lines{"abc", ""}));
  sut.append("f\n");
  EXPECT_EQ(lines_of(sut), Lines{"def"});
}

TEST(LineBuffer, tells_once_of_a_line_too_long_and_goes_on_behind_it) {
  LineBuffer sut(4);
  sut.append("123456");
  EXPECT_EQ(lines_of(sut), Lines{"too long"});
  sut.append("7890123456");
  EXPECT_EQ(lines_of(sut), Lines{});
  sut.append("78\nok\n12345\n1234\n");
  EXPECT_EQ(lines_of(sut), (Lines{"ok", "too long", "1234"}));
}

}  // namespace
}  // namespace gannet::control
