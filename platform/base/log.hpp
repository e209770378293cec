// Text for people, on standard error. Under systemd each line begins with its sd-daemon priority
// (<3> for an error), elsewhere with its word. Control thread and start-up; never on a real-time
// thread: that raises events.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "platform/base/event.hpp"

namespace gannet {

inline const char* to_string(Severity severity) {
  switch (severity) {
    case Severity::kCritical:
      return "critical";
    case Severity::kError:
      return "error";
    case Severity::kWarning:
      return "warning";
    case Severity::kNotice:
      return "notice";
    case Severity::kInfo:
      return "info";
    case Severity::kDebug:
      return "debug";
  }
  return "?";
}

// The line(s) that log() writes; a text of several lines gets the prefix on each.
inline std::string log_lines(Severity severity, std::string_view text, bool journal) {
  const std::string prefix = journal ? "<" + std::to_string(static_cast<int>(severity)) + ">"
                                     : std::string(to_string(severity)) + ": ";
  std::string lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines += prefix + std::string(text.substr(0, end)) + "\n";
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

inline void log(Severity severity, std::string_view text) {
  // systemd sets JOURNAL_STREAM for services whose standard error goes to the journal.
  static const bool journal = std::getenv("JOURNAL_STREAM") != nullptr;
  const std::string lines = log_lines(severity, text, journal);
  std::fwrite(lines.data(), 1, lines.size(), stderr);
}

}  // namespace gannet
