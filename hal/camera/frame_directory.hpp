// FrameDirectory: what lies in a folder of recorded pairs: left/ and right/ with PNG or JPEG files,
// paired in name order (by bytes, as `LC_ALL=C ls` has it), and perhaps times.csv. Nothing is
// decoded here. Start-up and normal threads.
//
// times.csv: a header `frame,time_s`, then a row for each pair. frame is the file's name without
// its ending, or the number that the name ends in (7 for left_0007.png); failing both, and with as
// many rows as pairs, rows are taken in order. Times are seconds from any origin, strictly rising.
//
// Errors: a missing folder, an image without its twin, a bad row (file:line).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "platform/base/result.hpp"

namespace gannet::hal {

struct FramePair {
  std::string name;  // of the left file without its ending
  std::string left;  // paths
  std::string right;
  double time_s = 0;  // from times.csv, else index / rate
};

struct FrameDirectory {
  std::vector<FramePair> pairs;  // at least one
  bool has_times = false;        // from times.csv
  double interval_s = 0;         // mean distance of two pairs; 1 / rate where there is only one
};

struct FrameTime {
  std::string frame;
  double time_s = 0;
};

// The rows of a times.csv; path is for the error alone. Any text may be given.
Result<std::vector<FrameTime>> parse_frame_times(const std::string& path, std::string_view text);

// rate_hz > 0: pairs per second where there is no times.csv.
Result<FrameDirectory> list_frames(const std::string& directory, double rate_hz);

}  // namespace gannet::hal
