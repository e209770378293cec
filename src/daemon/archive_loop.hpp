// ArchiveLoop: keeps pairs that vision has done with, as frames.kind says: none, or a directory of
// left/ and right/ PNG files with times.csv, which the replay camera reads again. When it is slow
// its line fills and vision sends pairs home; that is counted there. Archive thread, not real-time.
#pragma once

#include <cstdint>
#include <fstream>
#include <memory>
#include <string>

#include "platform/base/event.hpp"
#include "platform/base/result.hpp"
#include "src/config/daemon_config.hpp"
#include "src/daemon/frame_line.hpp"

namespace gannet::daemon {

class ArchiveLoop {
 public:
  // Null: nothing is to be kept. Error: the directory cannot be made, or holds frames already.
  static Result<std::unique_ptr<ArchiveLoop>> create(const config::FramesConfig& config,
                                                     EventPort* events);

  FrameLine& line() { return line_; }
  // Writes all pairs that wait; returns how many.
  int step(TimePoint now);
  std::uint64_t failures() const { return failures_; }

 private:
  explicit ArchiveLoop(std::string directory, EventPort* events)
      : directory_(std::move(directory)), events_(events) {}
  bool write(const hal::StereoFrame& frame);

  const std::string directory_;
  EventPort* events_;
  std::ofstream times_;
  std::uint64_t failures_ = 0;
  FrameLine line_{4};
};

}  // namespace gannet::daemon
