// ReplaySource: recorded pairs as numbered, timed and checked images, read when asked for. The pure
// part of the replay camera: no thread, no clock. Normal threads only (files, memory).
#pragma once

#include <cstdint>
#include <string>

#include "hal/camera/frame_directory.hpp"
#include "hal/camera/image_decoder.hpp"
#include "platform/base/time.hpp"

namespace gannet::hal {

struct ReplayPair {
  Image left;
  Image right;
};

class ReplaySource {
 public:
  // Decodes the first pair, which tells the size. Error: list_frames', or that pair's.
  static Result<ReplaySource> open(const std::string& directory, double rate_hz, bool loop,
                                   DecodeImage decode);

  int width() const { return width_; }
  int height() const { return height_; }
  // Pairs of the folder; with loop the index goes on beyond.
  std::uint64_t pairs() const { return frames_.pairs.size(); }
  bool has(std::uint64_t index) const { return loop_ || index < pairs(); }
  // After the first pair. Laps follow each other at the mean interval.
  Duration due(std::uint64_t index) const;
  Duration interval() const { return from_seconds(frames_.interval_s); }

  // Error: the file that cannot be read or decoded, or whose size differs; pair is then as it was.
  Result<void> load(std::uint64_t index, ReplayPair& pair) const;

 private:
  Result<Image> read(const std::string& path) const;

  FrameDirectory frames_;
  bool loop_ = false;
  DecodeImage decode_ = nullptr;
  int width_ = 0;  // 0: not known yet
  int height_ = 0;
};

}  // namespace gannet::hal
