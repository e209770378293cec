#include "src/world/camera_faults.hpp"

#include <gtest/gtest.h>

namespace gannet::world {
namespace {

using std::chrono::milliseconds;

constexpr TimePoint kExposed = time_from_ns(5'000'000'000);

TEST(CameraFaults, a_sound_pair_is_stamped_by_its_exposure_and_comes_later) {
  const PairTimes times = CameraFaults{}.times(kExposed, kExposed, milliseconds(40));
  for (const ImageTimes& image : times.of) {
    EXPECT_EQ(image.stamp, kExposed);
    EXPECT_EQ(image.available, kExposed + milliseconds(40));
  }
  EXPECT_FALSE(times.is_short);
}

TEST(CameraFaults, a_late_camera_has_a_true_stamp) {
  CameraFaults sut;
  sut.late[kLeftSide] = milliseconds(15);
  const PairTimes times = sut.times(kExposed, kExposed, milliseconds(40));
  EXPECT_EQ(times.of[kLeftSide].stamp, times.of[kRightSide].stamp);
  EXPECT_EQ(times.of[kLeftSide].available - times.of[kRightSide].available, milliseconds(15));
}

TEST(CameraFaults, a_skewed_camera_says_so) {
  CameraFaults sut;
  sut.skew[kRightSide] = milliseconds(15);
  const PairTimes times = sut.times(kExposed, kExposed, milliseconds(40));
  EXPECT_EQ(times.of[kRightSide].stamp - times.of[kLeftSide].stamp, milliseconds(15));
  EXPECT_EQ(times.of[kRightSide].available - times.of[kLeftSide].available, milliseconds(15));
}

TEST(CameraFaults, backward_stamps_mirror_time_and_frames_still_come) {
  CameraFaults sut;
  sut.backward_since = kExposed;
  TimePoint before = kExposed;
  for (int i = 1; i < 4; ++i) {
    const TimePoint t = kExposed + milliseconds(100 * i);
    const PairTimes times = sut.times(t, t, milliseconds(40));
    EXPECT_LT(times.of[kLeftSide].stamp, before);
    EXPECT_EQ(times.of[kLeftSide].available, t + milliseconds(40));
    before = times.of[kLeftSide].stamp;
  }
}

TEST(CameraFaults, a_frozen_picture_keeps_its_stamp) {
  const PairTimes times =
      CameraFaults{}.times(kExposed, kExposed + milliseconds(300), milliseconds(40));
  EXPECT_EQ(times.of[kLeftSide].stamp, kExposed);
  EXPECT_EQ(times.of[kLeftSide].available, kExposed + milliseconds(340));
}

}  // namespace
}  // namespace gannet::world
