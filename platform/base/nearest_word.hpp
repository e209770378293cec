// The known word that a mistyped one most likely meant, for "unknown key … did you mean …?".
// Any thread; allocates.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace gannet {

// Insertions, deletions, replacements and swaps of neighbours (optimal string alignment).
inline int edit_distance(std::string_view a, std::string_view b) {
  const std::size_t width = b.size() + 1;
  std::vector<int> d((a.size() + 1) * width);
  for (std::size_t i = 0; i <= a.size(); ++i) d[i * width] = static_cast<int>(i);
  for (std::size_t j = 0; j < width; ++j) d[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j < width; ++j) {
      const int replace = a[i - 1] == b[j - 1] ? 0 : 1;
      int best = std::min({d[(i - 1) * width + j] + 1, d[i * width + j - 1] + 1,
                           d[(i - 1) * width + j - 1] + replace});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        best = std::min(best, d[(i - 2) * width + j - 2] + 1);
      }
      d[i * width + j] = best;
    }
  }
  return d.back();
}

// Empty when nothing is near: more than a third of the letters differ (at least 2 may).
// Words: any range of things that convert to std::string_view; the first of equals wins.
template <class Words>
std::string_view nearest_word(std::string_view word, const Words& known) {
  std::string_view nearest;
  int least = std::max(2, static_cast<int>(word.size()) / 3) + 1;
  for (const auto& candidate : known) {
    const int distance = edit_distance(word, candidate);
    if (distance < least) {
      least = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

// " (did you mean x?)", or nothing.
template <class Words>
std::string did_you_mean(std::string_view word, const Words& known) {
  const std::string_view nearest = nearest_word(word, known);
  return nearest.empty() ? "" : " (did you mean " + std::string(nearest) + "?)";
}

}  // namespace gannet
