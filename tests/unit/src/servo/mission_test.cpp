#include "src/servo/mission.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gannet::servo {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr VisitLimits kLimits = {.tolerance_m = 0.01, .dwell = seconds(2)};
constexpr MissionFacts kThere = {
    .armed = true, .following = true, .target_sure = true, .error_m = 0.005};

class MissionTest : public testing::Test {
 protected:
  void run(const MissionFacts& facts, Duration length) {
    for (const TimePoint end = now_ + length; now_ < end; now_ += milliseconds(10)) {
      sut_ = step(sut_, 2, kLimits, facts, now_);
    }
  }
  MissionMemory sut_ = start_mission({}, 2, true);
  TimePoint now_ = TimePoint(seconds(100));
};

TEST_F(MissionTest, starts_only_while_armed) {
  EXPECT_EQ(start_mission({}, 2, false).state, MissionState::kIdle);
  EXPECT_EQ(start_mission({}, 0, true).state, MissionState::kIdle);
  EXPECT_EQ(sut_.state, MissionState::kRunning);
}

TEST_F(MissionTest, goes_on_after_the_dwell_and_ends_after_the_last_visit) {
  run(kThere, milliseconds(1990));
  EXPECT_EQ(sut_.visit, 0);
  run(kThere, milliseconds(100));
  EXPECT_EQ(sut_.visit, 1);
  EXPECT_EQ(sut_.state, MissionState::kRunning);
  run(kThere, seconds(3));
  EXPECT_EQ(sut_.visit, 1);
  EXPECT_EQ(sut_.state, MissionState::kDone);
}

TEST_F(MissionTest, a_lost_target_pauses_it_and_the_dwell_begins_again) {
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
