// FrameSink: where the simulated cameras' pairs go: shared memory (shared_frame_sink.hpp) or two
// V4L2 devices (v4l2_frame_sink.hpp). The cameras' drawing thread alone.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "hal/camera/image.hpp"
#include "platform/base/time.hpp"

namespace gannet::world {

enum Side : std::uint8_t { kLeftSide, kRightSide };

// Of one image: what its stamp says, and when it is handed to the daemon.
struct ImageTimes {
  TimePoint stamp;
  TimePoint available;
};

struct PairTimes {
  std::array<ImageTimes, 2> of;  // by Side
  bool is_short = false;         // both images end after a part of their bytes
};

// Faults that not every sink has a place for.
struct FrameSinkAbilities {
  bool short_frames = false;
  bool error_flags = false;
  bool two_stamps = false;  // each image has its own
};

class FrameSink {
 public:
  static constexpr hal::PixelFormat kFormat = hal::PixelFormat::kYuyv;
  static constexpr hal::ColourMatrix kMatrix = hal::ColourMatrix::kBt601;
  static constexpr hal::ColourRange kRange = hal::ColourRange::kLimited;

  virtual ~FrameSink() = default;

  virtual FrameSinkAbilities abilities() const = 0;
  virtual const hal::ImageLayout& layout() const = 0;  // of each image

  struct Images {
    std::span<std::uint8_t> left, right;
  };
  // Where to draw the next pair; empty: no room, the pair is lost.
  virtual std::optional<Images> begin_frame() = 0;
  // Hands over the pair that was begun.
  virtual void publish(const PairTimes& times) = 0;
};

}  // namespace gannet::world
