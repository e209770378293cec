// StereoCamera: a source of image pairs. Kinds: replay, simulated; V4L2 kinds beside them.
// Created by make_stereo_camera (camera_kinds.hpp) at start-up; owns the slots of its frames and
// must outlive them. capture() is for the capture thread alone.
#pragma once

#include <cstdint>

#include "hal/camera/stereo_frame.hpp"
#include "platform/base/result.hpp"
#include "platform/base/time.hpp"

namespace gannet::hal {

enum class CaptureStatus : std::uint8_t {
  kFrame,     // a pair was delivered
  kNothing,   // no pair within the time-out; not an error by itself
  kNoSlot,    // a pair came but all slots are out: dropped and counted
  kBroken,    // a pair came but was refused (short, stale, out of order): counted
  kLost,      // the device is gone; the camera tries to come back by itself
  kFinished,  // a replay has no more pairs
};

// Live: waits by CLOCK_MONOTONIC. Stepped: time is what capture() is told, and it never waits.
enum class Pace : std::uint8_t { kLive, kStepped };

struct CaptureCounters {
  std::uint64_t frames = 0;
  std::uint64_t dropped = 0;
  std::uint64_t broken = 0;
  std::uint64_t lost = 0;

  // Of cameras that see each image's story (V4L2), by image. All but missed are in broken too.
  std::uint64_t error_flagged = 0;  // the driver says that the pixels are damaged
  std::uint64_t short_frames = 0;   // fewer bytes than the format has
  std::uint64_t frozen = 0;         // the time stamp stands still
  std::uint64_t backward = 0;       // the time stamp goes back
  std::uint64_t off_clock = 0;      // the time stamp is not of the agreed clock, or far from it
  std::uint64_t unpaired = 0;       // no twin within the tolerance
  std::uint64_t undecoded = 0;      // broken when decompressed
  std::uint64_t decoded_late = 0;   // the decoder was busy or too slow
  std::uint64_t missed = 0;         // never given by the driver: gaps in its numbers
  double skew_s = 0;                // right stamp − left stamp, newest measured, paired or not
  double skew_max_s = 0;            // the largest so far, without sign
};

class StereoCamera {
 public:
  virtual ~StereoCamera() = default;

  virtual int width() const = 0;  // pixels of each image
  virtual int height() const = 0;

  // Starts the stream. Start-up only.
  virtual Result<void> start() = 0;

  // Waits at most until the time-out for the next pair. now is the loop's time: a stepped camera
  // gives what is due by then and never waits. RT safe.
  virtual CaptureStatus capture(TimePoint now, Duration timeout, StereoFrame& frame) = 0;

  virtual CaptureCounters counters() const = 0;  // capture thread
};

}  // namespace gannet::hal
