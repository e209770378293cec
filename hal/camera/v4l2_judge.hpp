// V4l2Judge: what is to be thought of a buffer that a driver gave: whole or not, new or old, and
// how many were lost before it. One for each stream; pure. Capture thread; RT safe.
#pragma once

#include <cstdint>

#include "hal/camera/stereo_camera.hpp"
#include "hal/camera/v4l2_system.hpp"

namespace gannet::hal {

enum class V4l2Fault : std::uint8_t {
  kNone,
  kErrorFlag,  // V4L2_BUF_FLAG_ERROR: the stream goes on, the pixels are damaged
  kShort,
  kFrozen,    // the stamp of the frame before
  kBackward,  // an older stamp
  kOffClock,  // not the agreed clock, or too far from it to be true
};

class V4l2Judge {
 public:
  // least_bytes: of a whole image. any_clock: a driver that does not name its clock is believed.
  V4l2Judge(std::size_t least_bytes, bool any_clock)
      : least_bytes_(least_bytes), any_clock_(any_clock) {}

  V4l2Fault judge(const v4l2_buffer& buffer, TimePoint now);

  // Of the buffer judged last.
  std::uint32_t missed() const { return missed_; }  // frames that the driver numbered and lost
  TimePoint stamp() const { return stamp_; }

 private:
  void count_missed(std::uint32_t sequence);
  V4l2Fault judge_stamp(const v4l2_buffer& buffer, TimePoint now);

  std::size_t least_bytes_;
  bool any_clock_;
  std::uint32_t sequence_ = 0;
  std::uint32_t missed_ = 0;
  TimePoint stamp_ = {};
  TimePoint newest_ = {};  // stamp of a good frame; the epoch: none yet
};

// Adds a fault to its counter and to broken.
void count(V4l2Fault fault, CaptureCounters& counters);

}  // namespace gannet::hal
