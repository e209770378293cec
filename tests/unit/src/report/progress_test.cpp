#include "src/report/progress.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace gannet::report {
namespace {

TimePoint at(double s) { return TimePoint{} + from_seconds(s); }

TEST(Progress, says_on_a_terminal_how_long_it_will_still_take) {
  std::ostringstream out;
  Progress sut(out, true, "map", 400, at(10));
  sut.update(100, at(20));
  EXPECT_NE(out.str().find("25 %"), std::string::npos);
  EXPECT_NE(out.str().find("100/400"), std::string::npos);
  EXPECT_NE(out.str().find("30 s left"), std::string::npos);
  EXPECT_EQ(out.str().find('\n'), std::string::npos);
  EXPECT_EQ(out.str()[0], '\r');
}

TEST(Progress, writes_no_faster_than_eyes_can_follow) {
  std::ostringstream out;
  Progress sut(out, true, "map", 10000, at(0));
  for (int i = 0; i < 1000; ++i) sut.update(i, at(i * 0.001));
  const std::string text = out.str();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\r'), 4);
}

TEST(Progress, keeps_quiet_in_a_log_while_the_run_is_short) {
  std::ostringstream out;
  Progress sut(out, false, "map", 100, at(0));
  for (int i = 0; i <= 100; ++i) sut.update(i, at(i * 0.2));
  sut.finish(at(20));
  EXPECT_EQ(out.str(), "");
}

TEST(Progress, writes_plain_lines_now_and_then_into_a_log) {
  std::ostringstream out;
  Progress sut(out, false, "papers", 100, at(0));
  for (int i = 0; i <= 100; ++i) sut.update(i, at(i));
  sut.finish(at(100));
  EXPECT_EQ(out.str(),
            "papers  30 %  30/100  1 min 10 s left\n"
            "papers  60 %  60/100  40 s left\n"
            "papers  90 %  90/100  10 s left\n"
            "papers  100/100 in 1 min 40 s\n");
}

TEST(Progress, a_run_that_is_given_up_says_how_far_it_came) {
  std::ostringstream out;
  Progress sut(out, false, "papers", 100, at(0));
  sut.update(40, at(40));
  sut.finish(at(41));
  EXPECT_NE(out.str().find("papers  40/100 in 41 s\n"), std::string::npos);
}

TEST(Progress, has_no_estimate_before_anything_is_done) {
  std::ostringstream out;
  Progress sut(out, true, "map", 100, at(0));
  sut.update(0, at(5));
  EXPECT_EQ(out.str().find("left"), std::string::npos);
}

TEST(DurationText, has_two_units) {
  EXPECT_EQ(duration_text(from_seconds(8.4)), "8 s");
  EXPECT_EQ(duration_text(from_seconds(200)), "3 min 20 s");
  EXPECT_EQ(duration_text(from_seconds(7500)), "2 h 05 min");
}

TEST(IsTerminal, a_descriptor_that_is_none_is_not) { EXPECT_FALSE(is_terminal(-1)); }

}  // namespace
}  // namespace gannet::report
