#include "src/report/progress.hpp"

#include <unistd.h>

#include <algorithm>

namespace gannet::report {
namespace {

constexpr Duration kTerminalPause = std::chrono::milliseconds(200);
constexpr Duration kLogPause = std::chrono::seconds(30);
constexpr int kBarWidth = 24;

std::string two_digits(long n) { return (n < 10 ? "0" : "") + std::to_string(n); }

}  // namespace

Progress::Progress(std::ostream& out, bool terminal, std::string what, long total, TimePoint start)
    : out_(out),
      terminal_(terminal),
      what_(std::move(what)),
      total_(std::max(total, 1L)),
      start_(start),
      last_(start) {}

void Progress::update(long done, TimePoint now) {
  done_ = std::clamp(done, 0L, total_);
  if (now - last_ < (terminal_ ? kTerminalPause : kLogPause)) return;
  last_ = now;
  written_ = true;
  // ESC [ K clears what a longer line left behind.
  out_ << (terminal_ ? "\r" + line(now) + "\x1b[K" : line(now) + "\n") << std::flush;
}

void Progress::finish(TimePoint now) {
  if (!written_) return;
  out_ << (terminal_ ? "\r" : "") << what_ << "  " << done_ << "/" << total_ << " in "
       << duration_text(now - start_) << (terminal_ ? "\x1b[K" : "") << "\n"
       << std::flush;
  written_ = false;
}

std::string Progress::line(TimePoint now) const {
  const double share = static_cast<double>(done_) / static_cast<double>(total_);
  std::string text = what_ + "  ";
  if (terminal_) {
    const int full = static_cast<int>(share * kBarWidth);
    for (int i = 0; i < kBarWidth; ++i) text += i < full ? "█" : "░";
    text += " ";
  }
  text += std::to_string(static_cast<int>(share * 100)) + " %  " + std::to_string(done_) + "/" +
          std::to_string(total_);
  if (done_ == 0) return text;
  // What is left takes as long as what is done took.
  const Duration left = from_seconds(to_seconds(now - start_) * (1 - share) / share);
  return text + "  " + duration_text(left) + " left";
}

bool is_terminal(int descriptor) { return isatty(descriptor) == 1; }

std::string duration_text(Duration duration) {
  const long s = static_cast<long>(to_seconds(duration) + 0.5);
  if (s < 60) return std::to_string(s) + " s";
  if (s < 3600) return std::to_string(s / 60) + " min " + two_digits(s % 60) + " s";
  return std::to_string(s / 3600) + " h " + two_digits(s / 60 % 60) + " min";
}

}  // namespace gannet::report
