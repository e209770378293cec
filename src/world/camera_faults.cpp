#include "src/world/camera_faults.hpp"

namespace gannet::world {

PairTimes CameraFaults::times(TimePoint stamp, TimePoint exposed, Duration latency) const {
  PairTimes times;
  times.is_short = is_short;
  const TimePoint told = backward_since ? *backward_since - (stamp - *backward_since) : stamp;
  for (const Side side : {kLeftSide, kRightSide})
    times.of[side] = {told + skew[side], exposed + skew[side] + latency + late[side]};
  return times;
}

}  // namespace gannet::world
