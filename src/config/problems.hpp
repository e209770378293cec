// Problems: everything that is wrong with what was read, told at once and in the order of the
// files and their lines, not in the order in which it was noticed. Start-up only.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "platform/base/result.hpp"

namespace gannet::config {

// Where a value stands: a file and a line, or what a person typed (line 0).
struct Origin {
  std::string source;
  int line = 0;

  std::string text() const { return line > 0 ? source + ":" + std::to_string(line) : source; }
};

class Problems {
 public:
  void add(const Origin& where, const std::string& what) {
    if (std::find(sources_.begin(), sources_.end(), where.source) == sources_.end())
      sources_.push_back(where.source);
    problems_.push_back({where, what});
  }

  bool empty() const { return problems_.empty(); }

  Error error() const {
    auto sorted = problems_;
    std::stable_sort(sorted.begin(), sorted.end(), [&](const auto& a, const auto& b) {
      return std::pair(rank(a.first), a.first.line) < std::pair(rank(b.first), b.first.line);
    });
    std::string text;
    for (const auto& [where, what] : sorted)
      text += (text.empty() ? "" : "\n") + where.text() + ": " + what;
    return {text};
  }

 private:
  std::size_t rank(const Origin& where) const {
    const auto at = std::find(sources_.begin(), sources_.end(), where.source);
    return static_cast<std::size_t>(at - sources_.begin());
  }
  std::vector<std::string> sources_;
  std::vector<std::pair<Origin, std::string>> problems_;
};

}  // namespace gannet::config
