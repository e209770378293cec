#include "src/world/reactions.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace gannet::world {
namespace {

// Armed at 1 s, pressed at 3 s, released at 4 s; the daemon is heard of every 10 ms.
Trace example() {
  Trace trace;
  trace.marks = {{1, "arm"}, {3.001, "press estop"}, {4, "release estop"}};
  trace.turns = {{0, true}, {1.0042, false}, {3.0051, true}};
  for (int i = 0; i <= 500; ++i) {
    TraceRow row;
    row.time_s = 0.01 * i;
    row.estop = row.time_s > 3 && row.time_s < 4;
    row.heard.supervisor = row.time_s < 1.005   ? "standby"
                           : row.time_s < 3.005 ? "servoing"
                                                : "stopped";
    trace.rows.push_back(row);
  }
  return trace;
}

TEST(Reactions, are_the_time_from_each_event_to_what_followed) {
  const auto sut = reactions_of(example());
  ASSERT_EQ(sut.size(), 3u);
  EXPECT_NEAR(sut[0].turning_ms, 4.2, 1e-6);
  EXPECT_TRUE(std::isnan(sut[0].still_ms));
  EXPECT_EQ(sut[0].state, "servoing");
  EXPECT_NEAR(sut[0].state_ms, 10, 1e-6);
  EXPECT_NEAR(sut[1].still_ms, 4.1, 1e-6);
  EXPECT_EQ(sut[1].state, "stopped");
}

TEST(Reactions, nothing_follows_a_release) {
  const auto sut = reactions_of(example());
  EXPECT_TRUE(std::isnan(sut[2].still_ms) && std::isnan(sut[2].turning_ms));
  EXPECT_EQ(sut[2].state, "");
}

TEST(Reactions, belong_to_the_last_event_before_them) {
  Trace trace = example();
  trace.marks.insert(trace.marks.begin() + 1, {2, "light 20"});
  EXPECT_TRUE(std::isnan(reactions_of(trace)[1].still_ms));
  EXPECT_NEAR(reactions_of(trace)[2].still_ms, 4.1, 1e-6);
  trace.turns.back().time_s = 3.001;  // in stepped time at once
  EXPECT_TRUE(std::isnan(reactions_of(trace)[1].still_ms));
  EXPECT_EQ(reactions_of(trace)[2].still_ms, 0);
}

TEST(Reactions, a_stop_must_last_while_the_button_is_pressed) {
  Trace trace = example();
  EXPECT_NEAR(stop_ms(trace, "press estop"), 4.1, 1e-6);
  trace.turns.push_back({4.5, false});
  EXPECT_NEAR(stop_ms(trace, "press estop"), 4.1, 1e-6);
  trace.turns.back().time_s = 3.5;
  EXPECT_TRUE(std::isnan(stop_ms(trace, "press estop")));
  EXPECT_TRUE(std::isnan(stop_ms(trace, "bus off")));  // never happened
}

TEST(Reactions, drives_that_stand_need_no_time) {
  EXPECT_EQ(stop_ms(example(), "release estop"), 0);
}

TEST(Reactions, are_told_as_a_table) {
  const std::string text = reactions_table(example());
  EXPECT_NE(text.find("press estop"), std::string::npos);
  EXPECT_NE(text.find("4.1"), std::string::npos) << text;
  EXPECT_EQ(reactions_table(Trace{}), "");
}

}  // namespace
}  // namespace gannet::world
