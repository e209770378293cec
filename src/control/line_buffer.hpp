// LineBuffer: bytes of a stream in, whole lines out, never more than a fixed number of bytes held.
// A longer line is dropped to its end and told once. A value; any one thread.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace gannet::control {

class LineBuffer {
 public:
  explicit LineBuffer(std::size_t max_line) : max_line_(max_line) {}

  enum class Next { kLine, kTooLong, kNothing };

  // Call next until kNothing after each append.
  void append(std::string_view bytes) { bytes_ += bytes; }
  Next next(std::string& line) {
    const std::size_t end = bytes_.find('\n', searched_);
    if (end == std::string::npos) {
      searched_ = bytes_.size();
      if (searched_ <= max_line_) return Next::kNothing;
      forget();
      if (dropping_) return Next::kNothing;
      dropping_ = true;
      return Next::kTooLong;
    }
    const bool tail = dropping_;  // the end of a line that was told of
    const bool too_long = end > max_line_;
    line.assign(bytes_, 0, end);
    bytes_.erase(0, end + 1);
    searched_ = 0;
    dropping_ = false;
    if (tail) return next(line);
    return too_long ? Next::kTooLong : Next::kLine;
  }

 private:
  void forget() {
    bytes_.clear();
    searched_ = 0;
  }
  std::string bytes_;
  std::size_t searched_ = 0;  // no newline before here
  bool dropping_ = false;
  const std::size_t max_line_;
};

}  // namespace gannet::control
