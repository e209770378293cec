#include "src/servo/mission.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gannet::servo {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr VisitLimits kLimits = {.tolerance_m = 0.01, .hold = seconds(2), .time_out = seconds(100)};
constexpr MissionFacts kThere = {
    .armed = true, .following = true, .target_sure = true, .error_m = 0.005};

class MissionTest : public testing::Test {
 protected:
  void run(const MissionFacts& facts, Duration length) {
    for (const TimePoint end = now_ + length; now_ < end; now_ += milliseconds(10)) {
      sut_ = step(sut_, 2, kLimits, facts, now_);
    }
  }
  MissionMemory sut_ = start_mission({}, 2, true, TimePoint(seconds(100)));
  TimePoint now_ = TimePoint(seconds(100));
};

TEST_F(MissionTest, starts_only_while_armed) {
  EXPECT_EQ(start_mission({}, 2, false, now_).state, MissionState::kIdle);
  EXPECT_EQ(start_mission({}, 0, true, now_).state, MissionState::kIdle);
  EXPECT_EQ(sut_.state, MissionState::kRunning);
}

TEST_F(MissionTest, goes_on_after_the_hold_and_ends_after_the_last_visit) {
  run(kThere, milliseconds(1990));
  EXPECT_EQ(sut_.visit, 0);
  run(kThere, milliseconds(100));
  EXPECT_EQ(sut_.visit, 1);
  EXPECT_EQ(sut_.state, MissionState::kRunning);
  run(kThere, seconds(3));
  EXPECT_EQ(sut_.visit, 1);
  EXPECT_EQ(sut_.state, MissionState::kDone);
}

TEST_F(MissionTest, a_lost_target_pauses_it_and_the_hold_begins_again) {
  run(kThere, milliseconds(1500));
  MissionFacts lost = kThere;
  lost.target_sure = false;
  run(lost, seconds(60));
  EXPECT_EQ(sut_.state, MissionState::kPaused);
  run(kThere, milliseconds(1500));
  EXPECT_EQ(sut_.state, MissionState::kRunning);
  EXPECT_EQ(sut_.visit, 0);
  run(kThere, milliseconds(600));
  EXPECT_EQ(sut_.visit, 1);
}

TEST_F(MissionTest, ends_when_no_longer_armed_and_does_not_resume) {
  MissionFacts disarmed = kThere;
  disarmed.armed = false;
  run(disarmed, milliseconds(10));
  EXPECT_EQ(sut_.state, MissionState::kStopped);
  run(kThere, seconds(10));
  EXPECT_EQ(sut_.state, MissionState::kStopped);
  EXPECT_EQ(sut_.visit, 0);
}

TEST_F(MissionTest, a_search_for_the_next_target_is_no_pause) {
  MissionFacts searching = kThere;
  searching.target_sure = false;
  run(searching, seconds(5));
  EXPECT_EQ(sut_.state, MissionState::kRunning);
}

TEST_F(MissionTest, a_hand_that_steers_pauses_it) {
  run(kThere, milliseconds(100));
  MissionFacts by_hand = kThere;
  by_hand.following = false;
  run(by_hand, seconds(5));
  EXPECT_EQ(sut_.state, MissionState::kPaused);
  EXPECT_TRUE(sut_.arrived);
}

TEST_F(MissionTest, a_visit_that_takes_too_long_waits_for_a_person_who_starts_it_again) {
  MissionFacts far = kThere;
  far.error_m = 0.02;
  run(far, seconds(101));
  ASSERT_EQ(sut_.state, MissionState::kTimedOut);
  run(kThere, seconds(10));
  EXPECT_EQ(sut_.state, MissionState::kTimedOut);
  EXPECT_EQ(start_mission(sut_, 2, false, now_).state, MissionState::kTimedOut);
  sut_.visit = 1;
  sut_ = start_mission(sut_, 2, true, now_);
  EXPECT_EQ(sut_.state, MissionState::kRunning);
  EXPECT_EQ(sut_.visit, 1);
  run(kThere, seconds(3));
  EXPECT_EQ(sut_.state, MissionState::kDone);
}

TEST_F(MissionTest, one_that_timed_out_ends_when_no_longer_armed) {
  run({.armed = true}, seconds(101));
  ASSERT_EQ(sut_.state, MissionState::kTimedOut);
  run({}, milliseconds(10));
  EXPECT_EQ(sut_.state, MissionState::kStopped);
}

TEST_F(MissionTest, a_running_one_is_not_started_again) {
  run(kThere, milliseconds(2100));
  ASSERT_EQ(sut_.visit, 1);
  EXPECT_EQ(start_mission(sut_, 2, true, now_).visit, 1);
}

TEST_F(MissionTest, an_error_that_is_no_number_is_not_there) {
  MissionFacts facts = kThere;
  for (const double error : {std::nan(""), std::numeric_limits<double>::infinity(), 0.0101}) {
    facts.error_m = error;
    run(facts, seconds(10));
    EXPECT_EQ(sut_.visit, 0);
  }
}

TEST_F(MissionTest, default_facts_and_limits_never_end_a_visit) {
  for (int i = 0; i < 1000; ++i) sut_ = step(sut_, 2, {}, kThere, now_ += seconds(1));
  EXPECT_EQ(sut_.visit, 0);
  EXPECT_EQ(step(sut_, 2, kLimits, {}, now_).state, MissionState::kStopped);
}

}  // namespace
}  // namespace gannet::servo
