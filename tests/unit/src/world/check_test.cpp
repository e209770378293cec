#include "src/world/check.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace gannet::world {
namespace {

// Ten seconds at 100 Hz: armed at 1 s, comes to the goal with 1/s from 0.3 m; e-stop at 6 s, from
// which the drives obey 30 ms later.
Trace example() {
  Trace trace;
  trace.motors = 2;
  trace.period_s = 0.01;
  trace.marks = {{1, "arm"}, {6, "press estop"}};
  for (int i = 0; i <= 1000; ++i) {
    TraceRow row;
    row.time_s = i * 0.01;
    const double error = 0.3 * std::exp(-std::max(0.0, row.time_s - 1));
    row.error_m = {error, 0, 0};
    row.error_rad = 0.01;
    row.estop = row.time_s > 5.999;
    row.armed = row.time_s > 0.999 && row.time_s < 6.025;
    if (row.armed) row.throttle = {0.4, -0.6};
    row.heard.frame = static_cast<std::uint64_t>(i / 3);
    row.heard.found = row.heard.frame % 4 != 0;
    row.heard.fitness = 0.8;
    row.heard.supervisor = row.time_s < 6.005 ? "servoing" : "stopped";
    row.heard.left_from_target.translation = {0.001, 0, 0.502};
    row.at_capture.translation = {0, 0, 0.5};
    trace.rows.push_back(row);
  }
  trace.turns = {{0, true}, {1, false}, {6.03, true}};
  trace.counters = {{"camera_broken", 7}};
  return trace;
}

Verdict verdict(const char* text) {
  const auto check = parse_check(text);
  EXPECT_TRUE(check) << (check ? "" : check.error().text);
  return judge(*check, example());
}

TEST(Check, judges_measures) {
  EXPECT_TRUE(verdict("settle_s < 2.75").passed);  // ln(300 / 20) = 2.71
  EXPECT_FALSE(verdict("settle_s < 2.65").passed);
  EXPECT_TRUE(verdict("rms_x_mm < 3 after 6 s").passed);
  EXPECT_FALSE(verdict("rms_x_mm < 3").passed);
  EXPECT_TRUE(verdict("rms_y_mm = 0").passed);
  EXPECT_TRUE(verdict("throttle > 0.59 until 5 s").passed);
  EXPECT_TRUE(verdict("throttle = 0 after 6.05 s until 9 s").passed);
  EXPECT_FALSE(verdict("throttle = 0 after 6 s until 9 s").passed);
  EXPECT_TRUE(verdict("found_share > 0.74").passed);
  EXPECT_TRUE(verdict("found_share < 0.76").passed);
  EXPECT_TRUE(verdict("estimate_z_mm < 2.001").passed);
  EXPECT_FALSE(verdict("estimate_z_mm < 1.999").passed);
  EXPECT_TRUE(verdict("fitness > 0.79").passed);
  EXPECT_TRUE(verdict("releases = 0").passed);
}

TEST(Check, judges_permits_and_states) {
  EXPECT_TRUE(verdict("permit none within 31 ms of press estop").passed);
  EXPECT_FALSE(verdict("permit none within 20 ms of press estop").passed);
  EXPECT_FALSE(verdict("permit none within 20 ms of release estop").passed);  // never happened
  EXPECT_TRUE(verdict("state is servoing at 5 s").passed);
  EXPECT_TRUE(verdict("state is stopped at 6.5 s").passed);
  EXPECT_FALSE(verdict("state is standby at 6.5 s").passed);
  EXPECT_TRUE(verdict("state stopped within 11 ms of press estop").passed);
  EXPECT_FALSE(verdict("state stopped within 9 ms of press estop").passed);
  EXPECT_FALSE(verdict("state faulted within 1000 ms of press estop").passed);
  EXPECT_FALSE(verdict("state stopped within 1000 ms of daemon gone").passed);
}

TEST(Check, judges_the_daemons_counters) {
  EXPECT_TRUE(verdict("counted camera_broken > 5").passed);
  EXPECT_TRUE(verdict("counted camera_broken = 7").passed);
  EXPECT_FALSE(verdict("counted camera_broken < 7").passed);
  EXPECT_FALSE(verdict("counted camera_brocken > 5").passed);
}

TEST(Check, a_motion_under_the_pressed_estop_is_no_stop) {
  Trace trace = example();
  trace.turns.push_back({7, false});
  const auto check = parse_check("permit none within 50 ms of press estop");
  ASSERT_TRUE(check);
  EXPECT_FALSE(judge(*check, trace).passed);
}

TEST(Check, a_time_without_frames_is_no_frame) {
  Trace trace = example();
  for (std::size_t i = 0; i < trace.rows.size(); ++i) {
    trace.rows[i].heard.found = true;
    if (i % 50 > 40) trace.rows[i].heard = {};  // coasting: no frame to speak of
  }
  EXPECT_TRUE(judge(*parse_check("found_share = 1"), trace).passed);
}

TEST(Check, what_cannot_be_said_fails) {
  const Trace nothing;
  for (const char* text : {"rms_x_mm < 10", "found_share > 0", "fitness > 0", "settle_s < 100",
                           "throttle = 0", "in_view < 2", "state is standby at 1 s"}) {
    const auto check = parse_check(text);
    ASSERT_TRUE(check) << text;
    EXPECT_FALSE(judge(*check, nothing).passed) << text;
  }
}

TEST(Check, refuses_what_it_does_not_understand) {
  for (const char* text :
       {"", "rms_x_mm", "rms_x_mm < ten", "rms_x_mm ~ 10", "rms_x_mm < 10 after 3",
        "rms_x_mm < 10 since 3 s", "rms_q_mm < 10", "permit none within 20 ms", "state stopped",
        "permit none within 20 ms of press button", "state is stopped at noon s",
        "state stopped within 20 ms", "state stopped within ten ms of press estop",
        "state stopped within 20 ms of press button", "counted", "counted x", "counted x ~ 3",
        "counted x > many"}) {
    EXPECT_FALSE(parse_check(text)) << text;
  }
}

}  // namespace
}  // namespace gannet::world
