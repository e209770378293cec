#include "src/daemon/archive_loop.hpp"

#include <cstdio>
#include <filesystem>

#include "src/image_file/image_file.hpp"
#include "src/telemetry/event_codes.hpp"

namespace gannet::daemon {

namespace fs = std::filesystem;

Result<std::unique_ptr<ArchiveLoop>> ArchiveLoop::create(const config::FramesConfig& config,
                                                         EventPort* events) {
  if (config.kind == "none") return std::unique_ptr<ArchiveLoop>();
  std::error_code problem;
  const fs::path directory = config.directory;
  if (fs::exists(directory / "times.csv", problem)) {
    return Error{"frames.directory '" + config.directory + "' holds a recording already: move it"};
  }
  fs::create_directories(directory / "left", problem);
  if (!problem) fs::create_directories(directory / "right", problem);
  if (problem) return Error{"frames.directory '" + config.directory + "': " + problem.message()};
  std::unique_ptr<ArchiveLoop> loop(new ArchiveLoop(config.directory, events));
  loop->times_.open(directory / "times.csv");
  loop->times_ << "frame,time_s\n" << std::flush;
  if (!loop->times_) return Error{"frames.directory '" + config.directory + "' is not writable"};
  return loop;
}

int ArchiveLoop::step(TimePoint now) {
  int written = 0;
  TakenFrame taken;
  while (line_.pop(taken)) {
    if (write(taken.frame)) {
      ++written;
    } else if (failures_++ == 0) {  // a full disk is told once
      events_->raise(telemetry::make_event(telemetry::kArchiveFailed, now,
                                           static_cast<double>(taken.frame.number)));
    }
    taken = TakenFrame();  // home, before the next one is waited for
  }
  return written;
}

bool ArchiveLoop::write(const hal::StereoFrame& frame) {
  char name[32];
  std::snprintf(name, sizeof name, "%08llu", static_cast<unsigned long long>(frame.number));
  const std::string file = std::string(name) + ".png";
  if (!image_file::write_png(directory_ + "/left/" + file, frame.left)) return false;
  if (!image_file::write_png(directory_ + "/right/" + file, frame.right)) return false;
  char row[64];
  std::snprintf(row, sizeof row, "%s,%.9f\n", name,
                static_cast<double>(to_ns(frame.capture_time)) * 1e-9);
  times_ << row << std::flush;
  return static_cast<bool>(times_);
}

}  // namespace gannet::daemon
