#include "platform/base/command_words.hpp"

#include <charconv>
#include <cmath>

namespace gannet {
namespace {

std::string plain(double number) {
  char text[64];
  const auto format =
      std::abs(number) < 1e15 ? std::chars_format::fixed : std::chars_format::general;
  return {text, std::to_chars(text, text + sizeof text, number, format).ptr};
}

}  // namespace

std::vector<std::string> split(std::string_view text, char at) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == at) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

std::string joined(const std::vector<std::string>& words, std::string_view between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : std::string(between)) + word;
  return text;
}

std::string range_text(const Argument& a) {
  const bool low = std::isfinite(a.min);
  const bool high = std::isfinite(a.max);
  if (low && high) return plain(a.min) + " to " + plain(a.max);
  if (low) return "at least " + plain(a.min);
  if (high) return "at most " + plain(a.max);
  return "";
}

}  // namespace gannet
