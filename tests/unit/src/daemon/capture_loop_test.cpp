#include "src/daemon/capture_loop.hpp"

#include <gtest/gtest.h>

#include "src/telemetry/event_codes.hpp"
#include "tests/support/daemon_fakes.hpp"

namespace gannet::daemon {
namespace {

using hal::CaptureStatus;
using std::chrono::milliseconds;

const TimePoint kNow = time_from_ns(5'000'000'000);

class CaptureLoopTest : public testing::Test {
 protected:
  test::FakeCamera camera_;
  FrameLine line_{2};
  LatestValue<CaptureReport> report_;
  EventPort events_;
  SharedFacts facts_;
  CaptureLoop sut_{{&camera_, &line_, &report_, &events_, &facts_}, milliseconds(3)};
};

TEST_F(CaptureLoopTest, hands_a_pair_on_with_its_corrected_time) {
  EXPECT_EQ(sut_.step(kNow, {}), CaptureStatus::kFrame);
  TakenFrame taken;
  ASSERT_TRUE(line_.pop(taken));
  EXPECT_EQ(taken.frame.capture_time, kNow - milliseconds(37));
  EXPECT_EQ(facts_.last_frame_ns, to_ns(kNow));
  EXPECT_EQ(report_.read().loop.cycles, 1u);
}

TEST_F(CaptureLoopTest, gives_a_pair_back_when_vision_has_no_room) {
  for (int i = 0; i < 5; ++i) sut_.step(kNow, {});
  EXPECT_EQ(report_.read().not_taken, 3u);
  EXPECT_EQ(camera_.at_home(), 6);
}

TEST_F(CaptureLoopTest, tells_once_that_the_camera_is_silent_and_once_that_it_is_back) {
  camera_.says = CaptureStatus::kLost;
  for (int i = 0; i < 3; ++i) sut_.step(kNow, {});
  camera_.says = CaptureStatus::kNothing;
  sut_.step(kNow, {});
  camera_.says = CaptureStatus::kFrame;
  sut_.step(kNow, {});
  Event event;
  ASSERT_TRUE(events_.take(event));
  EXPECT_EQ(event.code, telemetry::kCameraSilent);
  ASSERT_TRUE(events_.take(event));
  EXPECT_EQ(event.code, telemetry::kCameraBack);
  EXPECT_FALSE(events_.take(event));
}

TEST_F(CaptureLoopTest, tells_of_broken_pairs_ever_more_rarely) {
  camera_.says = CaptureStatus::kBroken;
  for (int i = 0; i < 100; ++i) sut_.step(kNow, {});
  int told = 0;
  for (Event event; events_.take(event);) ++told;
  EXPECT_EQ(told, 7);  // 1, 2, 4 … 64
}

}  // namespace
}  // namespace gannet::daemon
