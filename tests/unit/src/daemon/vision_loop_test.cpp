#include "src/daemon/vision_loop.hpp"

#include <gtest/gtest.h>

#include "tests/support/daemon_fakes.hpp"

namespace gannet::daemon {
namespace {

using std::chrono::milliseconds;

const TimePoint kNow = time_from_ns(5'000'000'000);

class VisionLoopTest : public testing::Test {
 protected:
  void give_frames(int n) {
    for (int i = 0; i < n; ++i) {
      TakenFrame taken;
      ASSERT_EQ(camera_.capture(kNow, {}, taken.frame), hal::CaptureStatus::kFrame);
      ASSERT_TRUE(frames_.push(std::move(taken)));
    }
  }
  VisionLoop make(bool preempt, FrameLine* archive = nullptr) {
    return VisionLoop(
        {&tracker_, &serial_, &frames_, archive, &choices_, &targets_, &report_, &events_, &facts_},
        preempt, milliseconds(100));
  }
  test::FakeCamera camera_;
  test::FakeTracker tracker_;
  Serial serial_;
  FrameLine frames_{8};
  FrameLine archive_{2};
  SpscRing<TargetChoice> choices_{4};
  SpscRing<SeenTarget> targets_{4};
  LatestValue<VisionReport> report_;
  EventPort events_;
  SharedFacts facts_;
};

TEST_F(VisionLoopTest, looks_at_the_newest_pair_and_gives_older_ones_back) {
  VisionLoop sut = make(false);
  give_frames(3);
  EXPECT_TRUE(sut.step(kNow));
  EXPECT_EQ(tracker_.frames, 1);
  EXPECT_EQ(report_.read().skipped, 2u);
  EXPECT_EQ(report_.read().estimate.frame_number, 3u);
  EXPECT_EQ(camera_.at_home(), 8);
}

TEST_F(VisionLoopTest, a_choice_holds_from_the_next_pair_on) {
  VisionLoop sut = make(false);
  choices_.push({TargetChoice::Kind::kModel, 1, {}, 7});
  give_frames(1);
  sut.step(kNow);
  SeenTarget seen;
  ASSERT_TRUE(targets_.pop(seen));
  EXPECT_EQ(seen.estimate.target_id, 7u);
  EXPECT_EQ(seen.estimate.model, 1);
  choices_.push({TargetChoice::Kind::kNone, -1, {}, 0});
  give_frames(1);
  sut.step(kNow);
  ASSERT_TRUE(targets_.pop(seen));
  EXPECT_EQ(seen.estimate.reason, TrackReason::kNoTarget);
}

TEST_F(VisionLoopTest, live_a_newer_pair_may_end_the_search_stepped_never) {
  VisionLoop live = make(true);
  give_frames(1);
  live.step(kNow);
  EXPECT_TRUE(tracker_.could_stop);
  EXPECT_FALSE(tracker_.stopped);
  VisionLoop stepped = make(false);
  give_frames(1);
  stepped.step(kNow);
  EXPECT_FALSE(tracker_.could_stop);
}

TEST_F(VisionLoopTest, the_track_ages_when_no_pair_comes) {
  VisionLoop sut = make(false);
  EXPECT_FALSE(sut.step(kNow));  // nothing was ever seen: nothing ages
  give_frames(1);
  sut.step(kNow);
  sut.step(kNow + milliseconds(99));
  EXPECT_EQ(tracker_.silences, 0);
  sut.step(kNow + milliseconds(101));
  EXPECT_EQ(tracker_.silences, 1);
  EXPECT_EQ(report_.read().estimate.reason, TrackReason::kNoFrames);
}

TEST_F(VisionLoopTest, hands_the_same_lease_on_to_the_archive_or_home) {
  VisionLoop sut = make(false, &archive_);
  for (int i = 0; i < 3; ++i) {
    give_frames(1);
    sut.step(kNow);
  }
  EXPECT_EQ(camera_.at_home(), 6);  // two wait in the archive's line, the third went home
  EXPECT_EQ(report_.read().not_archived, 1u);
  TakenFrame taken;
  ASSERT_TRUE(archive_.pop(taken));
  EXPECT_EQ(taken.frame.number, 1u);
  taken = TakenFrame();
  EXPECT_EQ(camera_.at_home(), 7);
}

TEST_F(VisionLoopTest, an_estimate_tells_what_time_it_took) {
  VisionLoop sut = make(false);
  give_frames(1);
  sut.step(kNow);
  EXPECT_GT(report_.read().estimate.time_spent.count(), 0);
}

TEST_F(VisionLoopTest, counts_estimates_that_servo_does_not_take) {
  VisionLoop sut = make(false);
  for (int i = 0; i < 6; ++i) {
    give_frames(1);
    sut.step(kNow);
  }
  EXPECT_EQ(report_.read().estimates_lost, 2u);
  EXPECT_EQ(report_.read().frame_to_pose.total(), 6u);
}

}  // namespace
}  // namespace gannet::daemon
