// Progress: how far a long run is and how long it will still take. On a terminal one line that is
// rewritten a few times a second; elsewhere (logs, pipes) a plain line now and then, nothing at all
// for runs that end before. Time is an argument. One thread, not real-time; the stream outlives it.
#pragma once

#include <ostream>
#include <string>

#include "platform/base/time.hpp"

namespace gannet::report {

class Progress {
 public:
  // total > 0 pieces of work. terminal: is_terminal() of the stream's descriptor.
  Progress(std::ostream& out, bool terminal, std::string what, long total, TimePoint start);

  // done pieces are finished; calls may come as often as convenient.
  void update(long done, TimePoint now);
  // The last line: everything is done, or was given up.
  void finish(TimePoint now);

 private:
  std::string line(TimePoint now) const;

  std::ostream& out_;
  const bool terminal_;
  const std::string what_;
  const long total_;
  const TimePoint start_;
  TimePoint last_;
  long done_ = 0;
  bool written_ = false;
};

bool is_terminal(int descriptor);

// "8 s", "3 min 20 s", "2 h 05 min".
std::string duration_text(Duration duration);

}  // namespace gannet::report
