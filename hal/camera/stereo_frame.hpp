// StereoFrame: a pair of images taken together, held by leases; move-only, one holder at a time.
// When the holder drops it the slots go home to the camera. The views are valid while it is held.
// RT safe.
#pragma once

#include <cstdint>

#include "hal/camera/image_view.hpp"
#include "platform/base/lease_pool.hpp"
#include "platform/base/time.hpp"

namespace gannet::hal {

struct StereoFrame {
  Lease left_lease;
  Lease right_lease;  // invalid where one slot carries both images
  ImageView left;
  ImageView right;
  TimePoint capture_time;    // middle of the exposure
  std::uint64_t number = 0;  // counts pairs from 1, gaps where pairs were lost
};

}  // namespace gannet::hal
